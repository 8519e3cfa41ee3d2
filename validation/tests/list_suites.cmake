# After each build of the tests: writes a CTest file with one test a suite, from what the executable itself lists.
# One process a suite and not one a test: Google Test's own work is then counted once.
# Reads EXECUTABLE; writes OUTPUT.
execute_process(COMMAND "${EXECUTABLE}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n[A-Za-z0-9_/]+\\.[ \n]" lines "\n${listed}")  # tests are indented, suites are not
list(TRANSFORM lines REPLACE "[\n. ]" "")
if(NOT lines)
  message(FATAL_ERROR "${EXECUTABLE} lists no test suite")
endif()
set(text "")
foreach(suite IN LISTS lines)
  string(APPEND text "add_test([=[${suite}]=] [=[${EXECUTABLE}]=] [=[--gtest_filter=${suite}.*]=])\n"
                     "set_tests_properties([=[${suite}]=] PROPERTIES TIMEOUT 300)\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}")
