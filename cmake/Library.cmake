# The library, which knows nothing of the renderer: shared for those who install it, static for those who want
# it inside of their program and for all that is built here, whose tests and trainings look inside.
file(GLOB_RECURSE ODIS_SOURCES CONFIGURE_DEPENDS src/odis/*.cpp)
if(NOT ODIS_TBB)
  list(FILTER ODIS_SOURCES EXCLUDE REGEX "/tbb_tasks\\.cpp$")
endif()
add_library(odis_objects OBJECT ${ODIS_SOURCES})
target_include_directories(odis_objects PRIVATE include src)
target_compile_definitions(odis_objects PRIVATE ODIS_SHARED ODIS_BUILDING $<$<BOOL:${ODIS_TBB}>:ODIS_TBB>)
target_link_libraries(odis_objects PRIVATE odis_compiler odis_version $<$<BOOL:${ODIS_TBB}>:TBB::tbb>)
# No fused multiplication and addition, which only some processors have: results are the same on all.
target_compile_options(odis_objects PRIVATE -ffp-contract=off)
set_target_properties(odis_objects PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
# What was learned comes with it.
odis_embed_bytes(odis_objects odis::core builtInWeights ${PROJECT_SOURCE_DIR}/weights/odis.weights)
odis_unity_by_folder(odis_objects)

add_library(odis SHARED $<TARGET_OBJECTS:odis_objects>)
target_compile_definitions(odis INTERFACE ODIS_SHARED)
set_target_properties(odis PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${ODIS_ABI})
# Visibility is not enough: templates of the standard library and resolvers of function clones are exported by
# themselves.
if(UNIX AND NOT APPLE)
  set(symbols ${PROJECT_SOURCE_DIR}/src/odis/api/exported_symbols.map)
  target_link_options(odis PRIVATE LINKER:--version-script=${symbols})
  set_target_properties(odis PROPERTIES LINK_DEPENDS ${symbols})
endif()

add_library(odis_static STATIC $<TARGET_OBJECTS:odis_objects>)
# On Windows the library that imports from odis.dll may have the name that this one has elsewhere.
set_target_properties(odis_static PROPERTIES OUTPUT_NAME $<IF:$<BOOL:${WIN32}>,odis_static,odis>)

foreach(library odis odis_static)
  add_library(odis::${library} ALIAS ${library})
  target_include_directories(${library} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${library} PRIVATE $<$<BOOL:${ODIS_TBB}>:TBB::tbb> Threads::Threads ${CMAKE_DL_LIBS})
endforeach()

# The network at pixels on oneDNN: a library of its own, which the others load when they are asked for it.
if(TARGET dnnl)
  file(GLOB ONEDNN_SOURCES CONFIGURE_DEPENDS src/onednn/*.cpp)
  add_library(odis_pixels MODULE ${ONEDNN_SOURCES})
  target_include_directories(odis_pixels PRIVATE include src)
  target_link_libraries(odis_pixels PRIVATE dnnl odis_compiler)
  set_target_properties(odis_pixels PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  odis_embed_bytes(odis_pixels odis::core paperWeights ${PROJECT_SOURCE_DIR}/weights/paper.weights)
  odis_embed_bytes(odis_pixels odis::core fastWeights ${PROJECT_SOURCE_DIR}/weights/fast.weights)
  odis_embed_bytes(odis_pixels odis::core paperGanWeights
    ${PROJECT_SOURCE_DIR}/weights/paper-gan.weights)
  odis_embed_bytes(odis_pixels odis::core fastGanWeights
    ${PROJECT_SOURCE_DIR}/weights/fast-gan.weights)
endif()
# Lets a program, or a library with the library inside, find what it may load from the build.
function(odis_finds TARGET)
  foreach(component IN LISTS ARGN)
    if(TARGET ${component})
      add_dependencies(${TARGET} ${component})
      set_property(TARGET ${TARGET} APPEND PROPERTY BUILD_RPATH $<TARGET_FILE_DIR:${component}>)
    endif()
  endforeach()
endfunction()
odis_finds(odis odis_pixels)
