# A unity build (CMAKE_UNITY_BUILD, as in the presets `release` and `fuzz`) compiles the files of a folder as one:
# the headers, which take longest, are read once. odis_unity_by_folder(TARGET SEPARATE...) groups the target's
# sources so; files named SEPARATE are compiled by themselves: those that hold other people's code.
function(odis_unity_by_folder TARGET)
  get_target_property(sources ${TARGET} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    get_filename_component(folder ${folder} NAME)
    get_filename_component(name ${source} NAME)
    if(NOT name IN_LIST ARGN)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
    endif()
  endforeach()
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()
