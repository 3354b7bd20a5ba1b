if(TARGET odis_openpgl)
  target_link_libraries(test_openpgl PRIVATE odis_openpgl)
  target_include_directories(test_openpgl PRIVATE ${PROJECT_SOURCE_DIR}/include)
  target_compile_definitions(test_openpgl PRIVATE ODIS_SOURCE="${PROJECT_SOURCE_DIR}"
    ODIS_CYCLES="$<TARGET_FILE_DIR:odis_openpgl>/odis-cycles")
else()
  set_target_properties(test_openpgl PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()
