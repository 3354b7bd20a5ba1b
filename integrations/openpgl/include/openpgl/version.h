// The version of Open PGL whose interface this is, for hosts that ask: 0.7.1, or 0.8.0 with ODIS_OPENPGL_8, which
// find_package(openpgl 0.8) defines. The library is the same.
#pragma once

#define OPENPGL_VERSION_MAJOR 0
#ifdef ODIS_OPENPGL_8
#define OPENPGL_VERSION_MINOR 8
#define OPENPGL_VERSION_PATCH 0
#define OPENPGL_IMAGE_SPACE_GUIDING_BUFFER
#define OPENPGL_VSP_GUIDING
#else
#define OPENPGL_VERSION_MINOR 7
#define OPENPGL_VERSION_PATCH 1
#endif
#define OPENPGL_VERSION_NOTE "ODIS"
