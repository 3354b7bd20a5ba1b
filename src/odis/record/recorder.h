// Turns the events of paths into path vertices: one call an event, and only complete vertices come out.
//
//   PathRecorder recorder;                       // one for each thread or tile
//   const uint32_t path = recorder.begin({pixel, sample});
//   for each ray of the path:
//     recorder.attenuation(path, factor)               // for each factor of its weight on the way, in media
//     recorder.surface(path, ...), recorder.medium(path, ...) or recorder.escape(path)
//     recorder.emission(path, ...)                     // for each emitter that the ray met
//     recorder.cached(path, radiance)                  // if the path ended with cached radiance
//     recorder.survived(path, probability)             // if roulette was played on arrival
//     recorder.light(path, ...), lightHidden(path)     // if a shadow ray was traced; if it was blocked
//     recorder.bounce(path, ...)                       // if the path was scattered, even if it ends then
//   recorder.finish()                                  // the vertices of all paths
//
// Many paths may be open at once, their events in any order as long as each path's own are in order. A
// surface or a place in a medium without a bounce (the path ended there by its depth, or by roulette on
// arrival) leaves no vertex.
#pragma once

#include <vector>

#include "odis/path_vertex.h"

namespace odis::core {

using PathIdentity = OdisPathIdentity;
using SurfaceEvent = OdisSurfaceEvent;
using MediumEvent = OdisMediumEvent;
using EmissionEvent = OdisEmissionEvent;
using LightEvent = OdisLightEvent;
using BounceEvent = OdisBounceEvent;

// 250 bytes a vertex while paths are open; memory is kept for the next ones. Not thread-safe. Throws
// std::out_of_range for a path that is not open, std::logic_error for events in an order that no path has,
// std::invalid_argument for numbers that no event has.
class PathRecorder {
 public:
  // Opens a path and returns its handle: 0, 1, 2, ... since the last finish().
  uint32_t begin(const PathIdentity& identity);

  void surface(uint32_t path, const SurfaceEvent& event);
  // The path is scattered in a medium.
  void medium(uint32_t path, const MediumEvent& event);
  // The ray under way is multiplied by this; emission that is told before is not.
  void attenuation(uint32_t path, const Float3& factor);
  // The ray left the scene. Emission of the environment follows as an event of its own.
  void escape(uint32_t path);
  void emission(uint32_t path, const EmissionEvent& event);
  // The path ended at its last surface, with this radiance in place of what it would have found.
  void cached(uint32_t path, const Float3& radiance);
  // Roulette on arrival let the path go on with this probability.
  void survived(uint32_t path, float probability);
  void light(uint32_t path, const LightEvent& event);
  // Something hides the light of the path's last light event; may be told after the bounce, too.
  void lightHidden(uint32_t path);
  void bounce(uint32_t path, const BounceEvent& event);

  // Closes all paths and returns their vertices, path after path, each with what only the complete path
  // knows: the radiance that arrives, contributions to the pixel, rays. They stay until the next begin().
  ArrayView<const PathVertex> finish();

  bool hasOpenPaths() const { return !m_paths.empty(); }
  uint64_t bytes() const;

 private:
  static constexpr uint32_t kNone = ~0u;
  // A vertex, with what it must remember until its path is complete.
  struct Pending {
    PathVertex vertex;
    uint32_t previous = kNone;    // of the same path
    Float3 throughput;            // of the path up to the vertex, it excluded
    Float3 emission;              // met by the vertex's direction, attenuated, without MIS weight
    Float3 attenuation{1, 1, 1};  // of its ray by now
    float emissionWeight = 0;     // MIS weight of that
    float survivalOnArrival = 1;
    uint32_t raysBefore = 0;  // traced by the path when the direction was sampled
  };
  struct OpenPath {
    PathIdentity identity;
    Float3 throughput{1, 1, 1};
    float survivalOnArrival = 1;
    Float3 cached;  // radiance that it ended with
    // Vertices: the last complete one, the one under way, that of the last light event.
    uint32_t last = kNone, current = kNone, lit = kNone;
    uint32_t count = 0;  // of complete vertices
    uint32_t surfaces = 0, rays = 0;
    bool ended = false;    // escaped, or ended with cached radiance
    bool decided = false;  // whether an event after its arrival at `current` is about that
  };
  OpenPath& open(uint32_t index);
  // A ray's end at a place where the path may be scattered, of this length.
  PathVertex& arrive(OpenPath& path, float distance);
  void complete(const OpenPath& path, PathVertex* vertices) const;

  std::vector<OpenPath> m_paths;
  std::vector<Pending> m_pending;
  std::vector<PathVertex> m_finished;
};

}  // namespace odis::core
