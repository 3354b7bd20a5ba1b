// The version of Open PGL whose interface this is, for hosts that ask.
#pragma once

#define OPENPGL_VERSION_MAJOR 0
#define OPENPGL_VERSION_MINOR 7
#define OPENPGL_VERSION_PATCH 1
#define OPENPGL_VERSION_NOTE "ODIS"
