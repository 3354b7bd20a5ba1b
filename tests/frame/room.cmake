target_link_libraries(test_frame PRIVATE TBB::tbb)
