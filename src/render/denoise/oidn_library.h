// Open Image Denoise (https://www.openimagedenoise.org) as a library that is looked for when the program
// runs: whoever doesn't denoise needs it neither to build nor to run. Versions 1.4 to 2.x have the functions
// below, some of them under two names; the declarations follow their oidn.h.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/files/library_error.h"

namespace odis::render {

// There is no denoiser, or it failed.
class DenoiserError : public LibraryError {
 public:
  using LibraryError::LibraryError;
};

struct OidnDevice;
struct OidnFilter;
// Takes how much is done, 0 to 1, from any thread; false asks to stop.
using OidnProgressFunction = bool (*)(void* user, double share);

inline constexpr int kOidnCpu = 1, kOidnFloat3 = 3;         // a type of device, a format of pixels
inline constexpr int kOidnNoError = 0, kOidnCancelled = 6;  // error codes

struct OidnLibrary {
  std::string path;  // that it was loaded from
  OidnDevice* (*newDevice)(int type);
  void (*releaseDevice)(OidnDevice*);
  void (*commitDevice)(OidnDevice*);
  void (*setDeviceBool)(OidnDevice*, const char* name, bool value);
  void (*setDeviceInt)(OidnDevice*, const char* name, int value);
  int (*getDeviceInt)(OidnDevice*, const char* name);
  int (*getDeviceError)(OidnDevice*, const char** message);
  OidnFilter* (*newFilter)(OidnDevice*, const char* type);
  void (*releaseFilter)(OidnFilter*);
  void (*setSharedFilterImage)(OidnFilter*, const char* name, void* pixels, int format, size_t width,
                               size_t height, size_t byteOffset, size_t bytePixelStride,
                               size_t byteRowStride);
  void (*setFilterBool)(OidnFilter*, const char* name, bool value);
  void (*setFilterInt)(OidnFilter*, const char* name, int value);
  void (*setProgressFunction)(OidnFilter*, OidnProgressFunction, void* user);
  void (*commitFilter)(OidnFilter*);
  void (*executeFilter)(OidnFilter*);
};

// Where the library is looked for, in this order, as names for dlopen(): the environment variable ODIS_OIDN
// and nothing else if it is set; the system's libraries; the packages pyoidn and oidn of the active Python
// environment (VIRTUAL_ENV); the same in `oidnSetupFolder()`.
std::vector<std::string> oidnCandidates();
// What `scripts/setup --denoise` fills: $XDG_DATA_HOME/odis/denoise, or ~/.local/share/odis/denoise.
std::string oidnSetupFolder();

// The library, loaded once and kept. Throws DenoiserError, which says where it was looked for and how to get
// it.
const OidnLibrary& oidnLibrary();

}  // namespace odis::render
