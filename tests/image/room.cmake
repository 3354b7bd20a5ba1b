# The test writes its images with stb and libjpeg, and 16-bit PNG by hand with zlib.
target_link_libraries(test_image PRIVATE stb JPEG::JPEG ZLIB::ZLIB)
