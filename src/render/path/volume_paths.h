// Paths through participating media, as Mitsuba's `volpath` has them (Scene::volumetric()).
#pragma once

#include <span>

#include "render/path/path.h"

namespace odis::render {

// Traces the rays of all paths side by side and takes everything else one path at a time. If `recorder` is
// given, the paths' handles are its.
void traceVolumePaths(const PathSettings& settings, std::span<Path> paths, PathRecorder* recorder);

// Follows each path to the first place where it is scattered on a surface that is no mirror, or in a medium:
// see traceFirstHits().
void traceFirstVolumeHits(const PathSettings& settings, std::span<Path> paths);

}  // namespace odis::render
