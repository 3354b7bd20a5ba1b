#include "learn/data/pilots.h"

#include "odis/guide.h"

#include <algorithm>
#include <cmath>

#include "odis/cells/statistics.h"
#include "render/path/pass.h"

namespace odis::learn {

namespace {

// Puts vertices that lie tile by tile in the order of the pixels.
void sortByPixel(const render::TileVertices& tiles, Pilot& pilot) {
  std::vector<const PathVertex*> paths(pilot.lengths.size(), nullptr);
  for (const std::vector<PathVertex>& tile : tiles)
    for (const PathVertex& v : tile) {
      if (v.depth == 1) paths[v.pixel] = &v;
      pilot.lengths[v.pixel] = uint8_t(v.depth);
    }
  for (size_t pixel = 0; pixel < paths.size(); ++pixel)
    pilot.vertices.insert(pilot.vertices.end(), paths[pixel], paths[pixel] + pilot.lengths[pixel]);
}

// Traces the pass, which wants the samples that it wants.
Pilot trace(const render::Scene& scene, const render::LightSampler& lights, uint64_t seed,
            render::Pass pass) {
  const render::Crop& crop = scene.film().crop;
  const size_t pixels = size_t(crop.width) * size_t(crop.height);
  pass.path.scene = &scene;
  pass.path.lights = &lights;
  pass.path.maxDepth = kDeepestPath;
  pass.seed = seed;
  pass.wantsVertices = true;
  Pilot pilot;
  pilot.image.assign(pixels, render::Rgb(0, 0, 0));
  render::TileVertices tiles(pass.sampledTiles().count());
  pass.deliver = [&](uint32_t tile, ArrayView<const FrameSample> samples,
                     ArrayView<const PathVertex> vertices) {
    for (const FrameSample& s : samples) pilot.image[s.pixel] = render::Rgb(s.value.x, s.value.y, s.value.z);
    tiles[tile].assign(vertices.begin(), vertices.end());
    // Data sets are of surfaces: they have no normal of zero.
    for (PathVertex& v : tiles[tile])
      if (isInMedium(v)) v.normal = {0, 0, 1}, v.discrete = true, v.guidableProbability = 0;
  };
  render::Progress silent;
  render::runPass(pass, silent, [] { return false; });

  pilot.lengths.assign(pixels, 0);
  sortByPixel(tiles, pilot);
  pilot.sampleWeight.assign(pixels, 1);
  for (const PathVertex& v : pilot.vertices) pilot.sampleWeight[v.pixel] = v.sampleWeight;
  return pilot;
}

// Leaves out what comes after each path's first usable vertex.
void cutOff(Pilot& pilot) {
  size_t left = 0, next = 0;
  for (uint8_t& length : pilot.lengths) {
    const size_t end = next + length;
    uint8_t kept = 0;
    for (bool found = false; next < end && !found; ++kept) {
      found = isUsable(pilot.vertices[next]);
      pilot.vertices[left++] = pilot.vertices[next++];
    }
    length = kept;
    next = end;
  }
  pilot.vertices.resize(left);
}

}  // namespace

Pilot tracePilot(const render::Scene& scene, const render::LightSampler& lights, uint64_t seed) {
  render::Pass pass;
  pass.samples = [](uint32_t) { return SampleRange{0, 1}; };
  return trace(scene, lights, seed, pass);
}

Pilot tracePilot(const render::Scene& scene, const render::LightSampler& lights, uint64_t seed,
                 const std::vector<bool>& wanted, std::vector<render::FeatureSums>& features) {
  render::Pass pass;
  pass.path.features = true;
  pass.features = &features;
  pass.samples = [&](uint32_t pixel) { return SampleRange{0, wanted[pixel] ? 1u : 0u}; };
  Pilot pilot = trace(scene, lights, seed, pass);
  cutOff(pilot);
  return pilot;
}

ViewFrame frameOf(std::span<const Pilot> pilots) {
  std::vector<ArrayView<const PathVertex>> parts;
  double sum = 0;
  size_t pixels = 0;
  for (const Pilot& pilot : pilots) {
    parts.emplace_back(pilot.vertices);
    for (const render::Rgb& c : pilot.image) sum += render::luminance(c);
    pixels += pilot.image.size();
  }
  core::CellStore cells(INFINITY);
  cells.add(parts, core::GuideOptions().cellsPerDiagonal);
  ViewFrame frame{cells.grid().origin(), cells.grid().finestEdge(), 1};
  const double mean = sum / double(std::max<size_t>(pixels, 1));
  if (mean > 0 && std::isfinite(mean)) frame.unit = float(mean);
  return frame;
}

}  // namespace odis::learn
