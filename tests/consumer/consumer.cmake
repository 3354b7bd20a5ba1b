# What was built here is installed into a folder, the folder is moved, and projects that know nothing of this
# one are built against it: some that find ODIS by CMake, and programs compiled by hand with what pkg-config
# says.
set(folder ${CMAKE_CURRENT_BINARY_DIR}/consumer)
set(components library development)
set(openpgl "")
if(TARGET odis_openpgl)
  list(APPEND components openpgl)
  set(openpgl -Dopenpgl_DIR=${folder}/moved/${CMAKE_INSTALL_LIBDIR}/odis/openpgl/cmake)
endif()
add_test(NAME Consumer.Install COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DFOLDER=${folder}
  "-DCOMPONENTS=${components}" -P ${CMAKE_CURRENT_LIST_DIR}/install.cmake)
set_tests_properties(Consumer.Install PROPERTIES FIXTURES_SETUP installed_odis LABELS consumer)

# A test that uses the installed tree.
function(odis_consumer_test name)
  add_test(NAME Consumer.${name} COMMAND ${ARGN})
  set_tests_properties(Consumer.${name} PROPERTIES FIXTURES_REQUIRED installed_odis LABELS consumer)
endfunction()

set(toolchain "")
if(CMAKE_TOOLCHAIN_FILE)
  set(toolchain -DCMAKE_TOOLCHAIN_FILE=${CMAKE_TOOLCHAIN_FILE})
endif()
# Sanitizers have to be in the programs, too. In a program of C alone they would need the C++ compiler.
set(options -DCMAKE_PREFIX_PATH=${folder}/moved ${openpgl} -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} ${toolchain}
  -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} "-DCMAKE_C_FLAGS=${CMAKE_CXX_FLAGS}")
set(run --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure --timeout 60)
odis_consumer_test(FindsItByCMake ${CMAKE_CTEST_COMMAND}
  --build-and-test ${CMAKE_CURRENT_LIST_DIR} ${folder}/build --build-generator ${CMAKE_GENERATOR} --build-options ${options}
    -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}" ${run})
if(NOT CMAKE_CROSSCOMPILING AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  odis_consumer_test(FindsItByCMakeInC ${CMAKE_CTEST_COMMAND}
    --build-and-test ${CMAKE_CURRENT_LIST_DIR}/c_only ${folder}/build_c --build-generator ${CMAKE_GENERATOR}
    --build-options ${options} ${run})
endif()
if(openpgl)
  odis_consumer_test(FindsOpenPgl8ByCMake ${CMAKE_CTEST_COMMAND}
    --build-and-test ${CMAKE_CURRENT_LIST_DIR}/openpgl_8 ${folder}/build_openpgl_8
    --build-generator ${CMAKE_GENERATOR} --build-options ${openpgl} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
    "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}" -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} ${toolchain} ${run})
endif()

find_program(ODIS_PKG_CONFIG pkg-config)
mark_as_advanced(ODIS_PKG_CONFIG)
if(ODIS_PKG_CONFIG AND NOT CMAKE_CROSSCOMPILING)
  odis_consumer_test(FindsItByPkgConfig ${CMAKE_CURRENT_LIST_DIR}/by_pkg_config
    ${PROJECT_SOURCE_DIR}/examples/minimal.c ${CMAKE_CURRENT_LIST_DIR}/consumer.cpp ${folder}/moved)
  set_tests_properties(Consumer.FindsItByPkgConfig PROPERTIES ENVIRONMENT
    "CC=${CMAKE_C_COMPILER} ${CMAKE_CXX_FLAGS};CXX=${CMAKE_CXX_COMPILER} ${CMAKE_CXX_FLAGS};PKG_CONFIG=${ODIS_PKG_CONFIG}")
endif()

# The manual as it is installed, and its commands that need an installed library.
find_program(ODIS_MANUAL_PYTHON python3)
mark_as_advanced(ODIS_MANUAL_PYTHON)
if(ODIS_MANUAL_PYTHON AND NOT CMAKE_CROSSCOMPILING)
  set(manual ${PROJECT_SOURCE_DIR}/tests/manual)
  odis_consumer_test(LinksOfTheManualLeadSomewhere ${ODIS_MANUAL_PYTHON} ${manual}/check_links.py
    ${folder}/moved/${CMAKE_INSTALL_DOCDIR})
  if(ODIS_PKG_CONFIG AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    odis_consumer_test(CommandsOfTheManualRun ${ODIS_MANUAL_PYTHON} ${manual}/run_commands.py
      --installed ${folder}/moved docs/packages.md examples/README.md)
  endif()
endif()
set_property(DIRECTORY APPEND PROPERTY ADDITIONAL_CLEAN_FILES ${folder})
