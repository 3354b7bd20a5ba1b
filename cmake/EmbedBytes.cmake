# A binary file into a program: odis_embed_bytes(TARGET NAMESPACE FUNCTION FILE) adds to TARGET a source that defines
# `std::string_view NAMESPACE::FUNCTION()`, the bytes of the file. As a script (cmake -P) this file writes the source,
# whenever the file has changed.
if(CMAKE_SCRIPT_MODE_FILE)
  file(READ ${FILE} hex HEX)
  # 32 bytes a line: a line is one match.
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(REGEX REPLACE "((0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,)(0x..,))" "\\1\n" bytes "${bytes}")
  file(WRITE ${OUTPUT} "// Made by cmake/EmbedBytes.cmake.
#include <string_view>

namespace ${NAMESPACE} {

std::string_view ${FUNCTION}();
std::string_view ${FUNCTION}() {
  static constexpr unsigned char kBytes[] = {
${bytes}};
  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes)};
}

}  // namespace ${NAMESPACE}
")
  return()
endif()

function(odis_embed_bytes TARGET NAMESPACE FUNCTION FILE)
  set(output ${PROJECT_BINARY_DIR}/generated/${TARGET}_${FUNCTION}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedBytes.cmake)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFILE=${FILE} -DOUTPUT=${output} -DNAMESPACE=${NAMESPACE} -DFUNCTION=${FUNCTION}
      -P ${script}
    DEPENDS ${FILE} ${script} VERBATIM)
  target_sources(${TARGET} PRIVATE ${output})
endfunction()
