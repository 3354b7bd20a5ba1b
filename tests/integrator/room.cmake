# Random scenes refer to files of other tests.
target_compile_definitions(test_integrator PRIVATE ODIS_SOURCE="${PROJECT_SOURCE_DIR}")
