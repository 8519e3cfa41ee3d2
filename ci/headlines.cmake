# Prints the verdict and the headline numbers of a report: cmake -DREPORT=report.json -P headlines.cmake
# (CMake reads JSON and is there anyway: no other tool is needed.)
file(READ "${REPORT}" json)
string(JSON verdict GET "${json}" verdict)
string(JSON count LENGTH "${json}" headlines)
set(text "\nverdict: ${verdict}\n")
foreach(i RANGE 1 ${count})
  if(i LESS_EQUAL count)  # RANGE 1 0 counts down
    math(EXPR index "${i} - 1")
    string(JSON label GET "${json}" headlines ${index} label)
    string(JSON value GET "${json}" headlines ${index} value)
    string(APPEND text "${label}: ${value}\n")
  endif()
endforeach()
execute_process(COMMAND "${CMAKE_COMMAND}" -E echo_append "${text}")  # message() would write to standard error
