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
install(FILES README.md CONTRIBUTING.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
# Pages lead to sources, too, which are not installed.
configure_file(cmake/installed_links.cmake.in generated/installed_links.cmake @ONLY)
install(SCRIPT ${PROJECT_BINARY_DIR}/generated/installed_links.cmake COMPONENT development)

# For CMake. A version 0.x promises nothing to users of another x.
install(EXPORT odis-targets NAMESPACE odis:: DESTINATION ${package} COMPONENT development)
set(ODIS_CXX_RUNTIME ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(FILTER ODIS_CXX_RUNTIME INCLUDE REGEX "^(stdc\\+\\+|c\\+\\+|m)$")
list(REMOVE_DUPLICATES ODIS_CXX_RUNTIME)
configure_package_config_file(cmake/odis-config.cmake.in generated/odis-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/odis-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/odis-config.cmake ${PROJECT_BINARY_DIR}/generated/odis-config-version.cmake
  DESTINATION ${package} COMPONENT development)

# For pkg-config: `odis` is the shared library, and `odis_static` the static one with what that needs: threads, the
# C++ runtime and oneTBB. A linker that is told -lodis takes the shared library where both are, so that
# `--static odis` serves only programs that are static in all parts. What it adds is no Requires.private, which
# would ask users of the shared library for oneTBB's headers.
file(RELATIVE_PATH ODIS_PC_TO_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" ODIS_PC_TO_PREFIX "${ODIS_PC_TO_PREFIX}")
set(needed ${ODIS_CXX_RUNTIME} ${CMAKE_DL_LIBS})
if(ODIS_TBB)
  list(PREPEND needed tbb)
endif()
list(TRANSFORM needed PREPEND -l)
list(APPEND needed ${CMAKE_THREAD_LIBS_INIT})
list(JOIN needed " " ODIS_PC_LIBS_PRIVATE)
foreach(name odis odis_static)
  configure_file(cmake/${name}.pc.in generated/${name}.pc.in @ONLY)
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/generated/${name}.pc INPUT ${PROJECT_BINARY_DIR}/generated/${name}.pc.in)
  install(FILES ${PROJECT_BINARY_DIR}/generated/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT development)
endforeach()

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
