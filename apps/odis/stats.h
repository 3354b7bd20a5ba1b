// What a rendering cost, for people and for programs.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "denoising.h"
#include "render/integrators/render.h"

namespace odis::app {

struct RunStats {
  render::RenderStats render;
  Denoising denoising;
  double secondsLoad = 0, secondsWrite = 0;
  double processorSeconds = 0;  // of all threads together, from the first sample to the image
  uint64_t bytesScene = 0, bytesPeak = 0;
  uint64_t seed = 0;
  bool cached = false;
  std::optional<eval::OperationCosts> costs;  // that decisions weighed; of frames that are guided
  std::string scene, integrator, film, commandLine;
};

uint64_t peakMemory();  // of this process, in bytes
std::string statsTable(const RunStats& stats);
std::string statsJson(const RunStats& stats);
// The same for the header of an EXR file; the time it took to write the file is not in it.
std::map<std::string, std::string> statsMetadata(const RunStats& stats);

}  // namespace odis::app
