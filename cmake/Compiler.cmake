# How everything here is compiled. odis_compiler carries the flags that are ours alone: it is linked privately, so
# nobody who uses the libraries inherits them.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
endif()

if((CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12) OR
   (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14))
  message(FATAL_ERROR "ODIS needs GCC 12 or Clang 14; found ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}.")
endif()

find_program(CCACHE ccache)
mark_as_advanced(CCACHE)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

add_library(odis_compiler INTERFACE)
# NaN and infinity keep their meaning (bad input is found by comparing with them), so no -ffast-math; errno and
# floating-point traps, which keep loops from being vectorised, are of no use here. Nobody replaces one of our functions
# when the program is loaded, so GCC may inline what is compiled for shared libraries as well.
target_compile_options(odis_compiler INTERFACE
  -Wall -Wextra $<$<BOOL:${ODIS_WERROR}>:-Werror> -fno-math-errno -fno-trapping-math -fno-semantic-interposition)

# Fuzz targets need to see which way the code under test took, and what it did wrong on it. Numbers that no integer
# stands for are not among what `undefined` means, though they become indices.
if(ODIS_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "ODIS_FUZZ needs Clang with its libFuzzer, found ${CMAKE_CXX_COMPILER_ID}: "
      "`scripts/setup --dev` installs it, `cmake --preset fuzz` chooses it.")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow
    -fno-sanitize-recover=undefined,float-cast-overflow -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
