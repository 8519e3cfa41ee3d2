# `cmake --install`: the command with its man page and completion, the libraries with their headers, and what
# find_package(plumbline) needs (ci/examples/consumer uses it).
include(CMakePackageConfigHelpers)
set(plumbline_package ${CMAKE_INSTALL_LIBDIR}/cmake/plumbline)
set_target_properties(plumbline_reference PROPERTIES EXPORT_NAME reference)
set_target_properties(plumbline_prt PROPERTIES EXPORT_NAME prt)
set_target_properties(plumbline_validation PROPERTIES EXPORT_NAME validation)
set_target_properties(plumbline_build PROPERTIES EXPORT_NAME build)

install(TARGETS plumbline RUNTIME)
install(TARGETS plumbline_pictures LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/plumbline)
install(TARGETS plumbline_build plumbline_reference plumbline_prt plumbline_validation EXPORT plumbline ARCHIVE)
install(EXPORT plumbline NAMESPACE plumbline:: FILE plumblineTargets.cmake DESTINATION ${plumbline_package})
foreach(folder reference prt validation)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/plumbline
    FILES_MATCHING PATTERN "*.hpp" PATTERN "plumbline_conformance.h" PATTERN tests EXCLUDE PATTERN bench EXCLUDE PATTERN app EXCLUDE)
endforeach()
install(FILES LICENSE README.md CONVENTIONS.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(ci/cmake/plumblineConfig.cmake.in ${PROJECT_BINARY_DIR}/plumblineConfig.cmake
  INSTALL_DESTINATION ${plumbline_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/plumblineConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/plumblineConfig.cmake ${PROJECT_BINARY_DIR}/plumblineConfigVersion.cmake
  DESTINATION ${plumbline_package})

# The command writes its own documents.
install(CODE "
  set(prefix \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
  foreach(pair \"man-page ${CMAKE_INSTALL_MANDIR}/man1/plumbline.1\"
               \"bash-completion ${CMAKE_INSTALL_DATADIR}/bash-completion/completions/plumbline\")
    string(REPLACE \" \" \";\" pair \"\${pair}\")
    list(GET pair 0 document)
    list(GET pair 1 file)
    cmake_path(GET file PARENT_PATH folder)
    file(MAKE_DIRECTORY \"\${prefix}/\${folder}\")
    execute_process(COMMAND \"$<TARGET_FILE:plumbline>\" --\${document} OUTPUT_FILE \"\${prefix}/\${file}\" COMMAND_ERROR_IS_FATAL ANY)
    message(STATUS \"Installing: \${prefix}/\${file}\")
  endforeach()
")
