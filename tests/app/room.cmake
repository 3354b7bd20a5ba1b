if(TARGET odis_app)
  target_link_libraries(test_app PRIVATE odis_commands OpenEXR::OpenEXR)
  target_compile_definitions(test_app PRIVATE ODIS_COMMAND="$<TARGET_FILE:odis_app>"
    ODIS_SOURCE="${PROJECT_SOURCE_DIR}")
  add_dependencies(test_app odis_app)
  # Each list of bad inputs is a test of its own; a new one is found when the program is linked again.
  file(GLOB BAD_INPUTS CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/bad_inputs/*.json)
  set_property(TARGET test_app APPEND PROPERTY LINK_DEPENDS ${BAD_INPUTS})
else()
  set_target_properties(test_app PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()
