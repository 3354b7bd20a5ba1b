#include "eval/reference.h"

#include <fmt/format.h>

#include <filesystem>

#include "eval/scene_hash.h"
#include "odis_version.h"

namespace odis::eval {

using namespace render;

// No run that is compared with a reference should share its random numbers.
static constexpr uint64_t kReferenceSeed = 0x9e3779b97f4a7c15u;

ColorImage cachedReference(const Scene& scene, const std::string& name, uint64_t sceneHash,
                           RenderOptions options, int spp, const std::string& folder, Progress& progress) {
  const FilmSettings& film = scene.film();
  const auto settingsAt = [&](int samples) {
    return fmt::format("scene {} size {}x{} crop {},{},{},{} depth {} roulette {} filter {} {} spp {}",
                       hexText(sceneHash), film.width, film.height, film.crop.x, film.crop.y, film.crop.width,
                       film.crop.height, options.maxDepth, options.rrDepth, film.filter->name(),
                       film.filter->radius(), samples);
  };
  const auto pathOf = [&](const std::string& settings) {
    return fmt::format("{}/{}-{}.exr", folder, name, hexText(hashText(settings)));
  };
  // One with twice, four times, ... as many samples is as good.
  for (int samples = spp; samples <= spp << 6 && samples > 0; samples *= 2)
    if (const std::string path = pathOf(settingsAt(samples)); std::filesystem::exists(path))
      return readColor(path);
  const std::string settings = settingsAt(spp), path = pathOf(settings);

  options.integrator = IntegratorKind::path;
  options.sampler = SamplerKind::independent;
  options.spp = spp;
  options.seed = kReferenceSeed;
  options.timeLimit = 0;
  options.variance = options.features = options.records = false;
  const RenderResult result = render::render(scene, options, progress);
  if (result.stats.interrupted) return {};
  std::filesystem::create_directories(folder);
  writeColor(path, result.frame, film.width, film.height,
             {{"odis:reference", settings}, {"odis:version", ODIS_VERSION_STRING}});
  return {result.frame.width, result.frame.height, result.frame.color};
}

}  // namespace odis::eval
