# cmake -D PROGRAM= -D LABEL= -D OUT= -D PROPERTIES= -P suites.cmake: writes the entries for ctest of a test program, one for each of its
# suites, named LABEL.SUITE. The suites are those that the program itself lists.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[^ \n]+\\.(\n|  #)" suites "\n${listed}")
set(entries)
foreach(line ${suites})
  string(REGEX REPLACE "[\n #]|\\.[\n #]*$" "" suite "${line}")
  string(APPEND entries "add_test([[${LABEL}.${suite}]] [[${PROGRAM}]] [[--gtest_filter=${suite}.*]])\n"
                        "set_tests_properties([[${LABEL}.${suite}]] PROPERTIES LABELS ${LABEL} ${PROPERTIES})\n")
endforeach()
file(WRITE ${OUT} "${entries}")
