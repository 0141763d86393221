# Fails unless CTest lists as many cases as are compiled into the test programs, and unless a program fails when it is
# asked for a case that it does not have.
#
#   PROGRAMS  the test programs
#   CTEST     the ctest command; it is run in the current folder, whose tests it lists
set(compiled_in 0)
foreach(program ${PROGRAMS})
  execute_process(COMMAND ${program} --count OUTPUT_VARIABLE count COMMAND_ERROR_IS_FATAL ANY)
  math(EXPR compiled_in "${compiled_in} + ${count}")
  foreach(call "--case;no such case" "--share;0;2;no such case" "no such case")
    execute_process(COMMAND ${program} ${call} RESULT_VARIABLE code OUTPUT_QUIET ERROR_QUIET)
    if(code EQUAL 0)
      message(FATAL_ERROR "${program} ${call}: expected a failure, for no case has this name; got exit code 0")
    endif()
  endforeach()
endforeach()
# Each entry of CTest runs exactly one case, or fails (catch_main.cpp).
execute_process(COMMAND ${CTEST} -N -L "^(unit|program)$" OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
if(NOT list MATCHES "Total Tests: ([0-9]+)")
  message(FATAL_ERROR "expected a number of tests from ctest, got\n${list}")
endif()
if(NOT CMAKE_MATCH_1 EQUAL compiled_in)
  message(FATAL_ERROR "expected CTest to run the ${compiled_in} cases that are compiled in, it runs ${CMAKE_MATCH_1}")
endif()
message("${compiled_in} cases compiled in and run")
