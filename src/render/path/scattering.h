// How a path is scattered at one place, guided or not: for those who trace paths one by one.
#pragma once

#include "render/path/scattering_point.h"
#include "render/sampler/random_stream.h"

namespace odis::render {

// A path under way.
struct Walker {
  Walker(Path& ofPath, const Medium* start)
      : path(&ofPath), medium(start), random(ofPath.sampler.streamSeed(1)) {}

  // Goes on to random numbers that no place has seen.
  void nextPlace() {
    ++place;
    random = RandomStream(path->sampler.streamSeed(place));
  }

  Path* path;
  const Medium* medium;  // that its ray is in; null for none
  int depth = 1;         // of the next vertex
  int place = 1;         // number of the next place that draws random numbers: vertices and what is passed
  RandomStream random;   // what the place needs beside the numbers that have purposes
  float travelled = 0;   // distance from the last vertex to where the ray begins
};

// The random numbers of a vertex: VertexNumber.
struct VertexDraws {
  VertexDraws() = default;
  explicit VertexDraws(Walker& walker);
  float lightChoice = 0, lobe = 0, survival = 0, shadowRay = 0;
  Vec2 lightPoint{0, 0}, direction{0, 0};
};

// What becomes of the path on its ray, which is so long until it meets a surface, in its medium. Distances
// are drawn towards the lights as well if there are any (null: none).
Flight fly(const LightSampler* lights, Walker& walker, float length);

// Whether a sample of this lobe passes straight through a surface, so that the path has no vertex there.
bool passesStraight(const Vertex& vertex, Lobe lobe);

// The transmittance towards a light at this distance (perhaps infinite), estimated; black if something hides
// it. Each ray is counted.
Rgb transmittanceTo(const Scene& scene, const ScatteringPoint& from, const Vec3& wi, float distance,
                    Walker& walker);

// Takes the path from a vertex, which the recorder (null: none) knows of, to its next ray: what is cached,
// roulette, next-event estimation, the next direction. Returns whether it has one.
bool scatter(const PathSettings& settings, PathRecorder* recorder, Walker& walker,
             const ScatteringPoint& point);

}  // namespace odis::render
