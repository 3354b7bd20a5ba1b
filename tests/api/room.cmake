target_link_libraries(test_api PRIVATE TBB::tbb)
