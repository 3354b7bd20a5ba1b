if(TARGET odis_app)
  target_link_libraries(test_app PRIVATE odis_commands)
  target_compile_definitions(test_app PRIVATE ODIS_COMMAND="$<TARGET_FILE:odis_app>"
    ODIS_SOURCE="${PROJECT_SOURCE_DIR}")
  add_dependencies(test_app odis_app)
else()
  set_target_properties(test_app PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()
