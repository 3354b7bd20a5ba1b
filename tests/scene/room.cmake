# A page of the manual is compared with what the program declares.
target_compile_definitions(test_scene PRIVATE ODIS_SOURCE="${PROJECT_SOURCE_DIR}")
