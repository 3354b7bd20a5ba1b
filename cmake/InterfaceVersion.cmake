# The version of the library, which its interface states: ODIS_INTERFACE_VERSION ("0.1.0") and ODIS_ABI.
set(header ${CMAKE_CURRENT_LIST_DIR}/../include/odis/odis.h)
file(STRINGS ${header} lines REGEX "^#define ODIS_(VERSION_[A-Z]+|ABI) [0-9]+$")
foreach(name VERSION_MAJOR VERSION_MINOR VERSION_PATCH ABI)
  if(NOT lines MATCHES "#define ODIS_${name} ([0-9]+)")
    message(FATAL_ERROR "${header}: found no line `#define ODIS_${name}` followed by a number, "
      "which the version of the library is read from.")
  endif()
  set(ODIS_${name} ${CMAKE_MATCH_1})
endforeach()
set(ODIS_INTERFACE_VERSION ${ODIS_VERSION_MAJOR}.${ODIS_VERSION_MINOR}.${ODIS_VERSION_PATCH})
