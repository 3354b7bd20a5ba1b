#include "stats.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "command.h"
#include "odis_version.h"

namespace odis::app {

uint64_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

static double secondsRendering(const render::RenderStats& s) {
  return s.secondsPilot + s.secondsBuild + s.secondsGuided;
}

std::string statsTable(const RunStats& stats) {
  const render::RenderStats& r = stats.render;
  std::string text;
  const auto row = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<18}{}\n", name, value);
  };
  const double seconds = secondsRendering(r);
  row("load", durationText(stats.secondsLoad));
  if (r.secondsPilot > 0) row("pilot", durationText(r.secondsPilot));
  if (r.secondsBuild > 0) row("build", durationText(r.secondsBuild));
  row("render", durationText(r.secondsGuided));
  const Denoising& d = stats.denoising;
  if (!d.denoiser.empty()) {
    row("albedo, normals", durationText(d.secondsAuxiliaries));
    row("denoise", fmt::format("{}, {}", durationText(d.seconds), d.denoiser));
  }
  row("write", durationText(stats.secondsWrite));
  row("samples per pixel", fmt::format("{:.4g}", r.spp));
  row("samples", fmt::format("{:.3f} M, {:.3f} M/s", double(r.samples) * 1e-6,
                             seconds > 0 ? double(r.samples) * 1e-6 / seconds : 0.0));
  row("rays",
      fmt::format("{:.3f} M, {:.3f} M shadow rays", double(r.rays) * 1e-6, double(r.shadowRays) * 1e-6));
  if (r.guidingGivenUp) row("guide", "given up, since it does not pay");
  if (r.cells > 0) {
    row("pilot vertices", fmt::format("{} in {} cells", r.pilotVertices, r.cells));
    row("pilot's share", fmt::format("{:.3f} of the samples' weight", r.pilotShare));
    row("cost of guiding",
        fmt::format("{:.1f} % of the time is build, a guided sample takes {:.2f} x a pilot's",
                    100 * r.secondsBuild / std::max(seconds, 1e-9), r.guidedCost()));
    row("memory of guide",
        fmt::format("{} while building, {:.0f} B a pilot vertex; maps {}", bytesText(double(r.bytesBuild)),
                    double(r.bytesBuild) / double(std::max<uint64_t>(r.pilotVertices, 1)),
                    bytesText(double(r.bytesMaps))));
  }
  row("memory of scene", bytesText(double(stats.bytesScene)));
  row("memory of lights", bytesText(double(r.bytesLights)));
  row("memory at most", bytesText(double(stats.bytesPeak)));
  return text;
}

std::string statsJson(const RunStats& stats) {
  const render::RenderStats& r = stats.render;
  nlohmann::ordered_json json = {{"version", ODIS_VERSION_STRING},
                                 {"commandLine", stats.commandLine},
                                 {"scene", stats.scene},
                                 {"integrator", stats.integrator},
                                 {"film", stats.film},
                                 {"cached", stats.cached},
                                 {"seed", stats.seed},
                                 {"spp", r.spp},
                                 {"interrupted", r.interrupted},
                                 {"seconds",
                                  {{"load", stats.secondsLoad},
                                   {"pilot", r.secondsPilot},
                                   {"build", r.secondsBuild},
                                   {"guided", r.secondsGuided},
                                   {"write", stats.secondsWrite}}},
                                 {"processorSeconds", stats.processorSeconds},
                                 {"samples", r.samples},
                                 {"rays", r.rays},
                                 {"shadowRays", r.shadowRays},
                                 {"pilotVertices", r.pilotVertices},
                                 {"cells", r.cells},
                                 {"guidingGivenUp", r.guidingGivenUp},
                                 {"pilotShare", r.pilotShare},
                                 {"guidedCost", r.guidedCost()},
                                 {"bytes",
                                  {{"peak", stats.bytesPeak},
                                   {"scene", stats.bytesScene},
                                   {"build", r.bytesBuild},
                                   {"lights", r.bytesLights},
                                   {"maps", r.bytesMaps}}},
                                 {"denoising", nullptr}};
  if (const auto& costs = stats.costs)
    json["costs"] = {{"guidedRay", costs->guidedRay},
                     {"builtCell", costs->builtCell},
                     {"recordedRay", costs->recordedRay}};
  const Denoising& d = stats.denoising;
  if (!d.denoiser.empty())
    json["denoising"] = {{"denoiser", d.denoiser},
                         {"auxiliaries", d.auxiliaries},
                         {"seconds", d.seconds},
                         {"secondsAuxiliaries", d.secondsAuxiliaries}};
  return json.dump(2) + "\n";
}

std::map<std::string, std::string> statsMetadata(const RunStats& stats) {
  const render::RenderStats& r = stats.render;
  std::map<std::string, std::string> metadata = {
      {"odis:version", ODIS_VERSION_STRING},
      {"odis:commandLine", stats.commandLine},
      {"odis:scene", stats.scene},
      {"odis:integrator", stats.integrator},
      {"odis:film", stats.film},
      {"odis:cached", stats.cached ? "yes: the image is biased" : "no"},
      {"odis:seed", std::to_string(stats.seed)},
      {"odis:spp", fmt::format("{}", r.spp)},
      {"odis:interrupted", r.interrupted ? "yes" : "no"},
      {"odis:secondsLoad", fmt::format("{:.4f}", stats.secondsLoad)},
      {"odis:secondsPilot", fmt::format("{:.4f}", r.secondsPilot)},
      {"odis:secondsBuild", fmt::format("{:.4f}", r.secondsBuild)},
      {"odis:secondsGuided", fmt::format("{:.4f}", r.secondsGuided)}};
  if (const auto& costs = stats.costs)
    metadata["odis:costs"] = fmt::format("guided ray {}, built cell {}, recorded ray {}", costs->guidedRay,
                                         costs->builtCell, costs->recordedRay);
  metadata.merge(denoisingMetadata(stats.denoising));
  return metadata;
}

}  // namespace odis::app
