#include "render/denoise/oidn_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace odis::render {

namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}

std::vector<fs::path> entriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    entries.push_back(it->path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

// The libraries that Python's packages pyoidn (OIDN 2) and oidn (OIDN 1) hold beside their code.
void addPackages(const fs::path& sitePackages, std::vector<std::string>& candidates) {
  const fs::path second = sitePackages / "pyoidn/oidn/lib/libOpenImageDenoise.so.2";
  if (fs::exists(second)) candidates.push_back(second.string());
  for (const fs::path& file : entriesOf(sitePackages / "oidn/lib.linux.x64"))
    if (file.filename().string().starts_with("libOpenImageDenoise.so")) candidates.push_back(file.string());
}

// Finds the function that has one of these names. False if there is none.
template <typename Function>
bool find(void* library, Function& function, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (void* const symbol = dlsym(library, name)) {
      function = reinterpret_cast<Function>(symbol);
      return true;
    }
  return false;
}

bool findAll(void* library, OidnLibrary& oidn) {
  return find(library, oidn.newDevice, {"oidnNewDevice"}) &&
         find(library, oidn.releaseDevice, {"oidnReleaseDevice"}) &&
         find(library, oidn.commitDevice, {"oidnCommitDevice"}) &&
         find(library, oidn.setDeviceBool, {"oidnSetDeviceBool", "oidnSetDevice1b"}) &&
         find(library, oidn.setDeviceInt, {"oidnSetDeviceInt", "oidnSetDevice1i"}) &&
         find(library, oidn.getDeviceInt, {"oidnGetDeviceInt", "oidnGetDevice1i"}) &&
         find(library, oidn.getDeviceError, {"oidnGetDeviceError"}) &&
         find(library, oidn.newFilter, {"oidnNewFilter"}) &&
         find(library, oidn.releaseFilter, {"oidnReleaseFilter"}) &&
         find(library, oidn.setSharedFilterImage, {"oidnSetSharedFilterImage"}) &&
         find(library, oidn.setFilterBool, {"oidnSetFilterBool", "oidnSetFilter1b"}) &&
         find(library, oidn.setFilterInt, {"oidnSetFilterInt", "oidnSetFilter1i"}) &&
         find(library, oidn.setProgressFunction, {"oidnSetFilterProgressMonitorFunction"}) &&
         find(library, oidn.commitFilter, {"oidnCommitFilter"}) &&
         find(library, oidn.executeFilter, {"oidnExecuteFilter"});
}

// Where it was looked for, and what was wrong with what was there.
std::string searchText(const std::vector<std::string>& reasons) {
  std::string text = missingText("Open Image Denoise 1.4 or later", "denoising",
                                 "`scripts/setup --denoise` installs it, or set ODIS_OIDN to the path of "
                                 "libOpenImageDenoise.so. Looked for: ");
  text += fmt::format(
      "ODIS_OIDN (not set); the system's libOpenImageDenoise.so.2, .so.1 and .so; the Python packages pyoidn "
      "and oidn in VIRTUAL_ENV ({}) and in {}",
      environment("VIRTUAL_ENV").empty() ? "not set" : environment("VIRTUAL_ENV"), oidnSetupFolder());
  for (const std::string& reason : reasons) text += "\n  " + reason;
  return text;
}

OidnLibrary load() {
  OidnLibrary oidn{};
  const bool chosen = !environment("ODIS_OIDN").empty();
  std::vector<std::string> reasons;
  for (const std::string& name : oidnCandidates()) {
    // It stays loaded, as its threads do.
    void* const library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    oidn.path = name;
    if (library && findAll(library, oidn)) return oidn;
    const char* const error = library ? nullptr : dlerror();
    const std::string reason = error ? error : name + ": is not Open Image Denoise 1.4 or later";
    if (chosen) throw DenoiserError("ODIS_OIDN: " + reason);
    // A library that is not there is no reason to tell; one that is there and can't be loaded is.
    if (library || fs::exists(name)) reasons.push_back(reason);
  }
  throw DenoiserError(searchText(reasons));
}

}  // namespace

std::string oidnSetupFolder() {
  const std::string data = environment("XDG_DATA_HOME");
  return (data.empty() ? environment("HOME") + "/.local/share" : data) + "/odis/denoise";
}

std::vector<std::string> oidnCandidates() {
  if (const std::string chosen = environment("ODIS_OIDN"); !chosen.empty()) return {chosen};
  std::vector<std::string> candidates{"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                      "libOpenImageDenoise.so"};
  if (const std::string active = environment("VIRTUAL_ENV"); !active.empty())
    for (const fs::path& python : entriesOf(fs::path(active) / "lib"))
      addPackages(python / "site-packages", candidates);
  addPackages(oidnSetupFolder(), candidates);
  return candidates;
}

const OidnLibrary& oidnLibrary() {
  static const OidnLibrary library = load();
  return library;
}

}  // namespace odis::render
