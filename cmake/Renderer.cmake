# All that is built upon the library: renderer, comparisons, training.

# The reference path tracer.
file(GLOB_RECURSE RENDER_SOURCES CONFIGURE_DEPENDS src/render/*.cpp)
if(openpgl_FOUND)
  list(FILTER RENDER_SOURCES EXCLUDE REGEX "/open_pgl_absent\\.cpp$")
else()
  list(FILTER RENDER_SOURCES EXCLUDE REGEX "/open_pgl\\.cpp$")
endif()
add_library(odis_render STATIC ${RENDER_SOURCES})
target_include_directories(odis_render PUBLIC src)
target_link_libraries(odis_render
  PUBLIC odis_static embree TBB::tbb Imath::Imath fmt::fmt
  PRIVATE odis_compiler OpenEXR::OpenEXR pugixml::pugixml stb JPEG::JPEG ZLIB::ZLIB ${CMAKE_DL_LIBS})
if(openpgl_FOUND)
  target_link_libraries(odis_render PRIVATE openpgl::openpgl)
endif()
target_compile_definitions(odis_render PUBLIC ODIS_EMBREE_MAJOR=${embree_VERSION_MAJOR})

# Metrics and comparisons.
file(GLOB_RECURSE EVAL_SOURCES CONFIGURE_DEPENDS src/eval/*.cpp)
add_library(odis_eval STATIC ${EVAL_SOURCES})
target_link_libraries(odis_eval
  PUBLIC odis_render nlohmann_json::nlohmann_json
  PRIVATE odis_compiler odis_version pugixml::pugixml)
# The page that shows a comparison.
file(GLOB REPORT_FILES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/eval/report/*)
odis_embed_text(odis_eval odis::eval reportFile eval/report.h ${REPORT_FILES})

# Scenes and data to learn from.
file(GLOB_RECURSE LEARN_SOURCES CONFIGURE_DEPENDS src/learn/*.cpp)
list(FILTER LEARN_SOURCES EXCLUDE REGEX "/learn/torch/")
add_library(odis_learn STATIC ${LEARN_SOURCES})
target_link_libraries(odis_learn
  PUBLIC odis_render nlohmann_json::nlohmann_json
  PRIVATE odis_compiler odis_version stb tinyobjloader::tinyobjloader ZLIB::ZLIB zstd ${CMAKE_DL_LIBS})
# What trains, loaded by who trains.
if(TARGET torch_learn)
  add_library(odis_learner MODULE src/learn/torch/learner.cpp src/learn/torch/pixel_learner.cpp)
  target_include_directories(odis_learner PRIVATE include src)
  target_link_libraries(odis_learner PRIVATE torch_learn Imath::Imath nlohmann_json::nlohmann_json odis_compiler)
endif()
odis_unity_by_folder(odis_render stb.cpp)
odis_unity_by_folder(odis_eval)
odis_unity_by_folder(odis_learn)
if(TARGET odis_learner)
  odis_unity_by_folder(odis_learner)
endif()
