# Files that the HTML report carries inside, embedded into the library: the page's own, and Chart.js from the system.
# Adds to plumbline_validation one generated source a file.
find_file(PLUMBLINE_CHART_JS
  NAMES chart.min.js chart.umd.min.js chart.umd.js
  PATHS /usr/share/javascript/chart.js /usr/share/nodejs/chart.js/dist /usr/local/share/javascript/chart.js
  DOC "Chart.js, minified (Debian: libjs-chart.js)"
  REQUIRED NO_DEFAULT_PATH)

function(plumbline_embed function input)
  set(output "${PROJECT_BINARY_DIR}/generated/validation/report/${function}.cpp")
  set(script "${CMAKE_CURRENT_SOURCE_DIR}/report/embed.cmake")
  add_custom_command(OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DINPUT=${input}" -DFUNCTION=${function} "-DOUTPUT=${output}" -P "${script}"
    DEPENDS "${input}" "${script}"
    COMMENT "Embedding ${input}"
    VERBATIM)
  target_sources(plumbline_validation PRIVATE "${output}")
endfunction()

plumbline_embed(page_html "${CMAKE_CURRENT_SOURCE_DIR}/report/page.html")
plumbline_embed(page_css "${CMAKE_CURRENT_SOURCE_DIR}/report/page.css")
plumbline_embed(page_js "${CMAKE_CURRENT_SOURCE_DIR}/report/page.js")
plumbline_embed(chart_js "${PLUMBLINE_CHART_JS}")
plumbline_embed(chart_js_licence "${CMAKE_CURRENT_SOURCE_DIR}/report/chart_js_licence.txt")
