target_link_libraries(test_learn PRIVATE odis_learn nlohmann_json::nlohmann_json pugixml::pugixml)
