// What scenes with media add to a bounce (Scene::volumetric()): rays that are scattered on their way,
// surfaces that let paths pass straight through, and shadow rays that are attenuated.
#pragma once

#include <optional>

#include "render/path/bounce.h"

namespace odis::render {

// The vertex of a path that is scattered in its medium, at this distance on its ray.
Vertex vertexInMedium(const Path& path, float distance);

// Draws what becomes of rays, whose ends on surfaces are known, in the media that they are in: paths are
// scattered there, or absorbed, or arrive with a weight.
void flyThroughMedia(const PathSettings& settings, std::span<Path> paths, int place, Batch& batch);

// Whether the surface that a path met is a light that the camera does not see (`hideEmitters`).
bool hidesLight(const Scene& scene, const Path& path, const Vertex& vertex);
// The factor of a path that goes straight on behind the surface that it met, no hidden light, without a
// vertex; nothing if the path has a vertex there. `place` as in Bounces.
std::optional<Rgb> passesStraight(const PathSettings& settings, int place, Path& path, const Vertex& vertex);
// Gives such a path its next ray.
void goStraightOn(Path& path, const Vertex& vertex);

// The medium that a ray gets into that leaves a vertex in this direction; null for none.
inline const Medium* mediumBeyond(const Arrival& arrival, const Vec3& direction) {
  const Vertex& vertex = *arrival.vertex;
  if (vertex.inMedium()) return arrival.path->medium;
  return vertex.at.shape->mediumBeyond(vertex.at, direction, arrival.path->medium);
}

// Traces the shadow rays that the batch was asked for, those of `lit` lanes, through media and through what
// lets light pass straight: adds the light that is left to the paths, and leaves it in the lanes.
void traceThroughMedia(const Scene& scene, Batch& batch, Bounces& bounces, const LaneList& lit);

}  // namespace odis::render
