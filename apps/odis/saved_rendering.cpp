#include "saved_rendering.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <filesystem>

#include "command.h"
#include "console.h"
#include "odis_version.h"
#include "render/files/input_file.h"
#include "render/files/output_path.h"

namespace odis::app {

using namespace render;

void checkSaving(const RenderArguments& a) {
  if (a.saveMinutes == 0 && a.resume.empty()) return;
  const std::string& integrator = a.method.integrator;
  if (integrator != "path" && integrator != "odis")
    throw UsageError("--save-every, --resume: expected --integrator path or odis, found " + integrator);
}

std::string savedFile(const RenderArguments& a) {
  if (!followOutput(a.output).isRegular)
    throw UsageError(fmt::format(
        "--save-every: found the output {}, expected a file beside which there can be another", a.output));
  return a.output + ".odis";
}

// A checksum over the contents of all files that the scene was read from.
static uint32_t checksumOf(const Scene& scene) {
  uLong crc = 0;
  for (const std::string& file : scene.files()) {
    const std::string bytes = readFile(file);
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  }
  return uint32_t(crc);
}

SavingOptions savingOf(const RenderArguments& a, const RenderOptions& options, const Scene& scene) {
  SavingOptions saving;
  if (a.saveMinutes == 0 && a.resume.empty()) return saving;
  if (a.saveMinutes > 0) saving.file = savedFile(a);
  saving.everySeconds = 60 * a.saveMinutes;
  saving.resumeFrom = a.resume;
  const FilmSettings& film = scene.film();
  const auto line = [&](const char* name, const std::string& value) {
    saving.subject += fmt::format("{}: {}\n", name, value);
  };
  line("version", ODIS_VERSION_STRING);
  line("files of the scene", fmt::format("{}, checksum {:08x}", scene.files().size(), checksumOf(scene)));
  line("-D", fmt::format("{}", fmt::join(a.part.defines, " ")));
  line("resolution", fmt::format("{}x{}", film.width, film.height));
  line("crop", fmt::format("{},{},{},{}", film.crop.x, film.crop.y, film.crop.width, film.crop.height));
  line("--integrator", a.method.integrator);
  line("--sampler", a.method.sampler);
  line("--film", filmName(options.film));
  line("--cached", a.method.cached ? "yes" : "no");
  line("--set", fmt::format("{}", fmt::join(a.method.settings, " ")));
  line("--spp", std::to_string(options.spp));
  line("--seed", std::to_string(options.seed));
  line("--max-depth", std::to_string(options.maxDepth));
  line("--rr-depth", std::to_string(options.rrDepth));
  // What is summed up along the way.
  line("--variance", options.variance && options.film == FilmKind::splat ? "yes" : "no");
  line("--aov", !options.features ? "none" : options.guideFeatures ? "guide" : "others than guide");
  line("--records", options.records ? "yes" : "no");
  return saving;
}

void tellOfSaved(const RenderArguments& a) {
  if (a.saveMinutes == 0 || a.quiet || !std::filesystem::exists(savedFile(a))) return;
  say(fmt::format("{}: saved, to go on with: --resume {}\n", savedFile(a), savedFile(a)));
}

void removeSaved(const RenderArguments& a) {
  std::error_code none;  // that it can't be removed is no harm
  if (a.saveMinutes > 0) std::filesystem::remove(savedFile(a), none);
}

}  // namespace odis::app
