# What was built here is installed into a folder, the folder is moved, and projects that know nothing of this
# one are built against it: one that finds ODIS by CMake, and a program compiled by hand with what pkg-config
# says.
set(folder ${CMAKE_CURRENT_BINARY_DIR}/consumer)
add_test(NAME Consumer.Install COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DFOLDER=${folder}
  -P ${CMAKE_CURRENT_LIST_DIR}/install.cmake)
set_tests_properties(Consumer.Install PROPERTIES FIXTURES_SETUP installed_odis LABELS consumer)

set(toolchain "")
if(CMAKE_TOOLCHAIN_FILE)
  set(toolchain -DCMAKE_TOOLCHAIN_FILE=${CMAKE_TOOLCHAIN_FILE})
endif()
# Sanitizers have to be in the program, too.
add_test(NAME Consumer.FindsItByCMake COMMAND ${CMAKE_CTEST_COMMAND}
  --build-and-test ${CMAKE_CURRENT_LIST_DIR} ${folder}/build --build-generator ${CMAKE_GENERATOR}
  --build-options -Dodis_ROOT=${folder}/moved -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} ${toolchain}
    -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
    "-DCMAKE_C_FLAGS=${CMAKE_CXX_FLAGS}" "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}"
  --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure --timeout 60)
set_tests_properties(Consumer.FindsItByCMake PROPERTIES FIXTURES_REQUIRED installed_odis LABELS consumer)

find_program(ODIS_PKG_CONFIG pkg-config)
mark_as_advanced(ODIS_PKG_CONFIG)
if(ODIS_PKG_CONFIG AND NOT CMAKE_CROSSCOMPILING)
  add_test(NAME Consumer.FindsItByPkgConfig
    COMMAND ${CMAKE_CURRENT_LIST_DIR}/by_pkg_config ${PROJECT_SOURCE_DIR}/examples/minimal.c ${folder}/moved)
  set_tests_properties(Consumer.FindsItByPkgConfig PROPERTIES FIXTURES_REQUIRED installed_odis LABELS consumer
    ENVIRONMENT "CC=${CMAKE_C_COMPILER} ${CMAKE_CXX_FLAGS};PKG_CONFIG=${ODIS_PKG_CONFIG}")
endif()
set_property(DIRECTORY APPEND PROPERTY ADDITIONAL_CLEAN_FILES ${folder})
