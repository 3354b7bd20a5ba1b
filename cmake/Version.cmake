# The version that outputs carry: "0.1.0" and, in a git checkout, the commit. Asked for when CMake configures; a new
# commit makes it configure again, and the header changes only if its text does.
set(ODIS_VERSION ${PROJECT_VERSION})
find_package(Git QUIET)
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --tags --match "v*" --abbrev=9
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE ODIS_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --path-format=absolute --git-path logs/HEAD
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE ODIS_GIT_LOG OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(ODIS_COMMIT)
    string(APPEND ODIS_VERSION " (${ODIS_COMMIT})")
  endif()
  if(EXISTS "${ODIS_GIT_LOG}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ODIS_GIT_LOG})
  endif()
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/odis_version.h.in ${PROJECT_BINARY_DIR}/generated/odis_version.h @ONLY)

add_library(odis_version INTERFACE)
target_include_directories(odis_version INTERFACE ${PROJECT_BINARY_DIR}/generated)
