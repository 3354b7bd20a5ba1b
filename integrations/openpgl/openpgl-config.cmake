# find_package(openpgl) gives openpgl::openpgl, the libopenpgl that is ODIS: with the headers of version 0.8 where that is
# asked for, else with those of 0.7.
include(${CMAKE_CURRENT_LIST_DIR}/openpgl-targets.cmake)
if(openpgl_VERSION VERSION_GREATER_EQUAL 0.8)
  set_property(TARGET openpgl::openpgl PROPERTY INTERFACE_COMPILE_DEFINITIONS ODIS_OPENPGL_8)
endif()
