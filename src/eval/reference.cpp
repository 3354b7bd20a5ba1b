#include "eval/reference.h"

#include <fmt/format.h>

#include <filesystem>

#include "eval/scene_hash.h"
#include "odis_version.h"
#include "render/image/write.h"

namespace odis::eval {

using namespace render;

// No run that is compared with a reference should share its random numbers.
static constexpr uint64_t kReferenceImageSeed = 0x9e3779b97f4a7c15u;

static constexpr const char* kSettingsKey = "odis:reference";

// The variance of each pixel's mean as the file tells it; empty if it doesn't.
static std::vector<Rgb> varianceOf(const ExrFile& file) {
  for (const bool squared : {true, false}) {
    std::vector<Rgb> result;
    for (int c = 0; c < 3; ++c) {
      const auto plane = file.channels.find((squared ? "variance." : "stderr.") + std::string(1, "RGB"[c]));
      if (plane == file.channels.end()) break;
      result.resize(plane->second.size());
      for (size_t i = 0; i < result.size(); ++i)
        result[i][c] = squared ? plane->second[i] : plane->second[i] * plane->second[i];
      if (c == 2) return result;
    }
  }
  return {};
}

Reference readReference(const std::string& path) {
  Reference reference;
  const ExrFile file = readChannels(path);
  reference.image = colorOf(file, path);
  reference.file = path;
  const auto settings = file.metadata.find(kSettingsKey);
  reference.settings = settings == file.metadata.end() ? path : settings->second;
  const std::vector<Rgb> variance = varianceOf(file);
  try {
    if (!variance.empty()) reference.error = referenceError(reference.image, variance);
  } catch (const std::invalid_argument& error) {
    throw ImageError(path + ": " + error.what());
  }
  return reference;
}

Reference cachedReference(const Scene& scene, const std::string& name, uint64_t sceneHash,
                          RenderOptions options, const std::string& folder, Progress& progress) {
  const int spp = options.spp;
  const FilmSettings& film = scene.film();
  const bool onFilmOnly = !film.sampleBorder && film.filter->reach() > 0;
  const auto settingsAt = [&](int samples) {
    return fmt::format("scene {} size {}x{} crop {},{},{},{} depth {} roulette {} filter {} {}{} spp {}",
                       hexText(sceneHash), film.width, film.height, film.crop.x, film.crop.y, film.crop.width,
                       film.crop.height, options.maxDepth, options.rrDepth, film.filter->name(),
                       film.filter->radius(), onFilmOnly ? " on the film" : "", samples);
  };
  const auto pathOf = [&](const std::string& settings) {
    return fmt::format("{}/{}-{}.exr", folder, name, hexText(hashText(settings)));
  };
  // One with twice, four times, ... as many samples is as good.
  for (int samples = spp; samples <= spp << 6 && samples > 0; samples *= 2)
    if (const std::string path = pathOf(settingsAt(samples)); std::filesystem::exists(path))
      return readReference(path);
  const std::string settings = settingsAt(spp), path = pathOf(settings);

  options.integrator = IntegratorKind::path;
  options.sampler = SamplerKind::independent;  // its variance can be told from one image
  options.seed = kReferenceImageSeed;
  options.timeLimit = 0;
  options.variance = true;
  options.features = options.records = false;
  const RenderResult result = render::render(scene, options, progress);
  if (result.stats.interrupted) return {};
  std::filesystem::create_directories(folder);
  writeColor(path, result.image, film.width, film.height,
             {{kSettingsKey, settings}, {"odis:version", ODIS_VERSION_STRING}});
  Reference reference = readReference(path);
  reference.secondsRendered = result.stats.secondsGuided;
  return reference;
}

}  // namespace odis::eval
