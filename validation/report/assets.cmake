# Files that the library carries inside: those of the HTML report (its own, and Chart.js from the system), and Blender's script.
# Adds to plumbline_validation one generated source a file.
find_file(PLUMBLINE_CHART_JS
  NAMES chart.min.js chart.umd.min.js chart.umd.js
  PATHS /usr/share/javascript/chart.js /usr/share/nodejs/chart.js/dist /usr/local/share/javascript/chart.js
  DOC "Chart.js, minified (Debian: libjs-chart.js)"
  REQUIRED NO_DEFAULT_PATH)

function(plumbline_embed namespace header function input)
  set(output "${PROJECT_BINARY_DIR}/generated/validation/${function}.cpp")
  set(script "${CMAKE_CURRENT_SOURCE_DIR}/report/embed.cmake")
  add_custom_command(OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DINPUT=${input}" -DNAMESPACE=${namespace} -DHEADER=${header} -DFUNCTION=${function}
            "-DOUTPUT=${output}" -P "${script}"
    DEPENDS "${input}" "${script}"
    COMMENT "Embedding ${input}"
    VERBATIM)
  target_sources(plumbline_validation PRIVATE "${output}")
endfunction()
function(plumbline_embed_asset function input)
  plumbline_embed(plumbline::report::assets validation/report/assets.hpp ${function} "${input}")
endfunction()

plumbline_embed_asset(page_html "${CMAKE_CURRENT_SOURCE_DIR}/report/page.html")
plumbline_embed_asset(page_css "${CMAKE_CURRENT_SOURCE_DIR}/report/page.css")
plumbline_embed_asset(page_js "${CMAKE_CURRENT_SOURCE_DIR}/report/page.js")
plumbline_embed_asset(chart_js "${PLUMBLINE_CHART_JS}")
plumbline_embed_asset(chart_js_licence "${CMAKE_CURRENT_SOURCE_DIR}/report/chart_js_licence.txt")
plumbline_embed(plumbline::study validation/study/cycles_script.hpp cycles_script "${CMAKE_CURRENT_SOURCE_DIR}/study/cycles.py")
