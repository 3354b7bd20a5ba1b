# Text files into a program: odis_embed_text(TARGET NAMESPACE FUNCTION HEADER FILE...) adds to TARGET a source that
# defines `std::string_view NAMESPACE::FUNCTION(const std::string& name)`, declared in HEADER, which returns the text of
# the file of that name. As a script (cmake -P) this file writes the source, whenever one of the files has changed.
if(CMAKE_SCRIPT_MODE_FILE)
  string(REPLACE "|" ";" FILES "${FILES}")
  set(entries "")
  foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    # Compilers need not take long literals: pieces of at most 8,000 characters stand side by side.
    string(LENGTH "${text}" length)
    set(literal "")
    set(at 0)
    while(at LESS length)
      string(SUBSTRING "${text}" ${at} 8000 piece)
      string(APPEND literal "\n     R\"odis(${piece})odis\"")
      math(EXPR at "${at} + 8000")
    endwhile()
    string(APPEND entries "    {\"${name}\",${literal}},\n")
  endforeach()
  file(WRITE ${OUTPUT} "// Made by cmake/EmbedText.cmake.
#include \"${HEADER}\"

#include <map>

namespace ${NAMESPACE} {

std::string_view ${FUNCTION}(const std::string& name) {
  static const std::map<std::string, std::string_view> kFiles{
${entries}  };
  return kFiles.at(name);
}

}  // namespace ${NAMESPACE}
")
  return()
endif()

function(odis_embed_text TARGET NAMESPACE FUNCTION HEADER)
  set(output ${PROJECT_BINARY_DIR}/generated/${TARGET}_${FUNCTION}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake)
  string(REPLACE ";" "|" files "${ARGN}")
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFILES=${files} -DOUTPUT=${output} -DNAMESPACE=${NAMESPACE} -DFUNCTION=${FUNCTION}
      -DHEADER=${HEADER} -P ${script}
    DEPENDS ${ARGN} ${script} VERBATIM)
  target_sources(${TARGET} PRIVATE ${output})
endfunction()
