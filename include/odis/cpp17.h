// Says what is amiss where a host compiles for an older standard, before the compiler complains of the rest.
#pragma once

#if defined(_MSVC_LANG)
#define ODIS_CPP_STANDARD _MSVC_LANG  // whose __cplusplus stays 199711 unless /Zc:__cplusplus is given
#else
#define ODIS_CPP_STANDARD __cplusplus
#endif
static_assert(ODIS_CPP_STANDARD >= 201703L,
              "ODIS's headers in C++ need C++17 or later: compile with -std=c++17 or /std:c++17");
#undef ODIS_CPP_STANDARD
