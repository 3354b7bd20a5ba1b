// max_depth, rr_depth and hide_emitters of integrators of any type, the number of samples of any sampler.
// What else they have says how Mitsuba finds the picture, not what it shows.
#include "render/scene/load_integrator.h"

#include <algorithm>
#include <limits>

#include "render/xml/names.h"

namespace odis::render {
namespace {

constexpr int kMost = std::numeric_limits<int>::max();

// Integrators of Mitsuba 3 and 0.6 that show the radiance that paths of all lengths bring, as this program
// does.
const std::vector<std::string> kPathIntegrators = {
    "bdpt",           "emission_volpath", "erpt",       "mlt",     "odis",
    "path",           "photonmapper",     "ppm",        "prb",     "prb_basic",
    "prb_projective", "prbvolpath",       "pssmlt",     "ptracer", "sppm",
    "volpath",        "volpath_simple",   "volpathmis", "vpl"};
// Those among them that know of media.
const std::vector<std::string> kVolumetricIntegrators = {"emission_volpath", "prbvolpath", "volpath",
                                                         "volpath_simple", "volpathmis"};
// Those that show something else.
const std::vector<std::string> kOtherIntegrators = {"ao", "depth", "field"};
// Those that show direct light, and those that measure another integrator's picture and hold it.
const std::vector<std::string> kDirectIntegrators = {"direct", "direct_projective"},
                               kWrappingIntegrators = {"adaptive", "aov",          "irrcache",
                                                       "moment",   "multichannel", "stokes"};

bool isIn(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

void warnOfType(const Properties& node, bool holdsOther, Warnings& warnings) {
  const std::string& type = node.type;
  const std::string name = "the integrator '" + type + "' ";
  // "" if the file leaves it to a variable that has no value.
  if (type.empty() || type == "path" || type == "odis") return;
  if (isIn(kPathIntegrators, type)) {
    warnings.add(node.location, name + "is replaced by this program's, which shows the same", Effect::same);
  } else if (isIn(kDirectIntegrators, type)) {
    warnings.add(node.location, name + "is replaced by this program's with paths of depth 2", Effect::same);
  } else if (isIn(kWrappingIntegrators, type) && holdsOther) {
    warnings.add(node.location, name + "is left out, the picture is that of the integrator in it",
                 Effect::same);
  } else {
    const std::string fault = isIn(kWrappingIntegrators, type) ? "holds no other"
                              : isIn(kOtherIntegrators, type)
                                  ? "shows something else than radiance"
                                  : "is unknown" + suggestion(type, {"direct", "odis", "path"});
    warnings.add(node.location, name + fault + ", the radiance that paths bring is shown");
  }
}

void readIntegrator(const Properties* node, IntegratorSettings& settings, Warnings& warnings) {
  settings.type = node->type;
  while (true) {
    const Properties* nested = node->child("integrator");
    warnOfType(*node, nested, warnings);
    if (!nested) break;
    warnOfMisspelt(*node, warnings);
    node = nested;
  }
  settings.volumetric = isIn(kVolumetricIntegrators, node->type);
  settings.maxDepth = int(node->integer("max_depth", between(-1, kMost), -1));
  if (isIn(kDirectIntegrators, node->type)) settings.maxDepth = kDirectLightDepth;
  // 0.6 counts it from one, too, but allows a zero.
  settings.rrDepth = int(node->integer("rr_depth", between(0, kMost), 5));
  settings.hideEmitters = node->boolean("hide_emitters", false);
  warnOfMisspelt(*node, warnings);
}

int readSampleCount(const Properties& sampler, Warnings& warnings) {
  if (sampler.type != "independent" && sampler.type != "sobol")
    warnings.add(sampler.location,
                 "in place of the sampler '" + sampler.type + "' this program's draws as many samples",
                 Effect::same);
  const int64_t count = sampler.integer("sample_count", between(1, kMost), 1);
  sampler.describeFallback("sample_count", "4");
  warnOfMisspelt(sampler, warnings);
  return sampler.has("sample_count") ? int(count) : 0;
}

}  // namespace

IntegratorSettings loadIntegrator(const Properties* integrator, const Properties* sampler,
                                  Warnings& warnings) {
  IntegratorSettings settings;
  settings.type = "";
  if (integrator) readIntegrator(integrator, settings, warnings);
  if (sampler) settings.samplesPerPixel = readSampleCount(*sampler, warnings);
  return settings;
}

}  // namespace odis::render
