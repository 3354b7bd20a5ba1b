if(ODIS_MANUAL_PYTHON)
  add_test(NAME Manual.NamesEveryCallOfOpenPgl
    COMMAND ${ODIS_MANUAL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/check_openpgl_page.py)
endif()

# The commands of the manual run, and print what the manual says. (Under sanitizers the tests of the command run
# the same code.)
if(TARGET odis_app AND ODIS_MANUAL_PYTHON AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(run ${ODIS_MANUAL_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/run_commands.py --odis $<TARGET_FILE:odis_app>)
  add_test(NAME Manual.CommandsRun COMMAND ${run})
  # A page in which every block is wrong in a way of its own.
  add_test(NAME Manual.WrongBlocksAreFound COMMAND ${run} tests/manual/wrong_blocks.md)
  set_tests_properties(Manual.WrongBlocksAreFound PROPERTIES PASS_REGULAR_EXPRESSION
    ":3: error: found a block of ''.*:7: error: found 'frobnicate.*:11: error: exit code 2.*:15: error: .*expected.samples.*:20: error: .*place of examples/nothing.py.*:24: error: .*place of nothing.*:28: 1 run")
endif()
