# The list of the interface, and these tests as text.
target_compile_definitions(test_api PRIVATE ODIS_SOURCE="${PROJECT_SOURCE_DIR}")
