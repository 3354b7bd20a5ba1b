# The test writes its images with stb.
target_link_libraries(test_texture PRIVATE stb)
