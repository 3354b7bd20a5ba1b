// How a rendering ends that may have been stopped early: what is kept of it, what is said, and the exit code.
#pragma once

#include "render/integrators/render.h"
#include "render_arguments.h"

namespace odis::app {

// Whether the image should be written; says so where not.
bool isWorthWriting(const RenderArguments& a, const render::RenderStats& stats);
// "4 samples per pixel", or how far a rendering came that was stopped, and by what.
std::string samplesText(const render::RenderStats& stats, int asked);
// An ExitCode.
int renderExitCode(const RenderArguments& a, const render::RenderStats& stats);

}  // namespace odis::app
