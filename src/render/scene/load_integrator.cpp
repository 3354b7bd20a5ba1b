#include "render/scene/load_integrator.h"

#include <limits>

namespace odis::render {
namespace {

constexpr int kMost = std::numeric_limits<int>::max();

void readDepths(const Properties* node, IntegratorSettings& settings, Warnings& warnings) {
  settings.type = node->type;
  if (node->type != "path" && node->type != "odis" && !node->type.empty())
    warnings.add(
        node->location,
        "the integrator '" + node->type +
            "' is not one of path and odis, the integrator of this program is used with its path depths");
  // Integrators that record something about another hold that other one.
  while (const Properties* nested = node->child("integrator")) node = nested;
  settings.maxDepth = int(node->integer("max_depth", between(-1, kMost), -1));
  // 0.6 counts it from one, too, but allows a zero.
  settings.rrDepth = int(node->integer("rr_depth", between(0, kMost), 5));
  if (node->boolean("hide_emitters", false))
    warnings.add(node->placeOf("hide_emitters"), "'hide_emitters' is not supported and is ignored");
  warnOfMisspelt(*node, warnings);
}

int readSampleCount(const Properties& sampler, Warnings& warnings) {
  if (sampler.type != "independent" && sampler.type != "sobol")
    warnings.add(sampler.location, "the sampler '" + sampler.type +
                                       "' is not one of independent and sobol, the sampler of this program "
                                       "is used with its sample count");
  const int64_t count = sampler.integer("sample_count", between(1, kMost), 1);
  warnOfMisspelt(sampler, warnings);
  return sampler.has("sample_count") ? int(count) : 0;
}

}  // namespace

IntegratorSettings loadIntegrator(const Properties* integrator, const Properties* sampler,
                                  Warnings& warnings) {
  IntegratorSettings settings;
  settings.type = "";
  if (integrator) readDepths(integrator, settings, warnings);
  if (sampler) settings.samplesPerPixel = readSampleCount(*sampler, warnings);
  return settings;
}

}  // namespace odis::render
