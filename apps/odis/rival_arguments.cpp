#include "rival_arguments.h"

#include <CLI/CLI.hpp>

#include "validators.h"

namespace odis::app {

using render::PpgOptions;
using render::QuadtreeFilter;

void PpgArguments::addTo(CLI::App& app) {
  const std::string group = "Practical path guiding";
  app.add_option("--ppg", version, "2017: as first published; 2019: improved. The others change one thing")
      ->check(CLI::IsMember({"2017", "2019"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--ppg-threshold", threshold,
                 "Samples that halve a leaf of the first iteration; 2017: 12000, 2019: 4000")
      ->check(numberBetween(1, 1e9))
      ->group(group);
  app.add_option("--ppg-flux", flux, "Share of a leaf's light that divides a quadrant; default: 0.01")
      ->check(numberBetween(1e-6, 1))
      ->group(group);
  app.add_option("--ppg-spatial", spatial, "Where vertices are recorded; 2017: nearest leaf, 2019: jitter")
      ->check(CLI::IsMember({"nearest", "jitter", "box"}))
      ->group(group);
  app.add_option("--ppg-directional", directional, "How directions are spread; 2017: nearest, 2019: box")
      ->check(CLI::IsMember({"nearest", "box"}))
      ->group(group);
  app.add_option("--ppg-combine", combine, "Which iterations make the image; 2017: last, 2019: variance")
      ->check(CLI::IsMember({"last", "variance"}))
      ->group(group);
  app.add_option("--ppg-share", share, "Share of draws that stays with the BSDF; 2017: half, 2019: learned")
      ->check(CLI::IsMember({"half", "learned"}))
      ->group(group);
}

PpgOptions PpgArguments::options() const {
  PpgOptions options = version == "2017" ? PpgOptions::firstPublished() : PpgOptions();
  options.threshold = threshold.value_or(options.threshold);
  options.flux = flux.value_or(options.flux);
  if (spatial)
    options.spatial = *spatial == "nearest"  ? PpgOptions::Spatial::nearest
                      : *spatial == "jitter" ? PpgOptions::Spatial::jitter
                                             : PpgOptions::Spatial::box;
  if (directional)
    options.directional = *directional == "nearest" ? QuadtreeFilter::nearest : QuadtreeFilter::box;
  if (combine)
    options.combine = *combine == "last" ? PpgOptions::Combine::last : PpgOptions::Combine::inverseVariance;
  if (share) options.share = *share == "half" ? PpgOptions::Share::fixed : PpgOptions::Share::learned;
  return options;
}

void RestirArguments::addTo(CLI::App& app) {
  const std::string group = "Resampling";
  app.add_option("--restir-neighbours", options.neighbours, "Pixels whose sample is tried as well")
      ->check(CLI::Range(0, 64))
      ->capture_default_str()
      ->group(group);
  app.add_option("--restir-radius", options.radius, "How far away they are at most, in pixels")
      ->check(numberBetween(0, 1e4))
      ->capture_default_str()
      ->group(group);
}

}  // namespace odis::app
