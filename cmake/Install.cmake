# `cmake --install`, in the components `library` (what programs need to run), `development` (what they are
# built with), `command`, and `training`, which needs libtorch. The tree may be moved afterwards.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/odis)

install(TARGETS odis odis_static EXPORT odis-targets
  LIBRARY COMPONENT library NAMELINK_COMPONENT development
  RUNTIME COMPONENT library
  ARCHIVE COMPONENT development)
install(DIRECTORY include/odis DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILES_MATCHING PATTERN *.h PATTERN *.hpp)
install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT library)
install(FILES README.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
file(GLOB pages docs/*.md)
install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT development)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)

# For CMake. A version 0.x promises nothing to users of another x.
install(EXPORT odis-targets NAMESPACE odis:: DESTINATION ${package} COMPONENT development)
configure_package_config_file(cmake/odis-config.cmake.in generated/odis-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/odis-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/odis-config.cmake ${PROJECT_BINARY_DIR}/generated/odis-config-version.cmake
  DESTINATION ${package} COMPONENT development)

# For pkg-config. With --static it adds what the static library needs: threads, the C++ runtime and oneTBB.
# The latter is no Requires.private, which would ask users of the shared library for oneTBB's headers.
file(RELATIVE_PATH ODIS_PC_TO_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" ODIS_PC_TO_PREFIX "${ODIS_PC_TO_PREFIX}")
set(runtime ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(FILTER runtime INCLUDE REGEX "^(stdc\\+\\+|c\\+\\+|m)$")
list(REMOVE_DUPLICATES runtime)
if(ODIS_TBB)
  list(PREPEND runtime tbb)
endif()
list(TRANSFORM runtime PREPEND -l)
list(APPEND runtime ${CMAKE_THREAD_LIBS_INIT})
list(JOIN runtime " " ODIS_PC_LIBS_PRIVATE)
configure_file(cmake/odis.pc.in generated/odis.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/generated/odis.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT development)

# Command and library find what they load by their own place.
if(TARGET odis_app)
  install(TARGETS odis_app RUNTIME COMPONENT command)
  file(RELATIVE_PATH components ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/odis)
  set_target_properties(odis_app PROPERTIES INSTALL_RPATH $ORIGIN/${components})
endif()
if(TARGET odis_pixels)
  install(TARGETS odis_pixels LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/odis COMPONENT paper)
  set_target_properties(odis PROPERTIES INSTALL_RPATH $ORIGIN/odis)
endif()
if(TARGET odis_app AND TARGET odis_learner)
  install(TARGETS odis_learner LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/odis COMPONENT training)
  # libtorch may lie in a wheel, outside of where the loader looks.
  set_target_properties(odis_learner PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
endif()
