#include "learn/data/pilots.h"

#include <odis/guide.h>

#include <algorithm>
#include <cmath>

#include "odis/cells/statistics.h"
#include "render/integrator/pass.h"

namespace odis::learn {

namespace {

// Puts vertices that lie tile by tile in the order of the pixels.
void sortByPixel(const render::Records& tiles, Pilot& pilot) {
  std::vector<const PilotVertex*> paths(pilot.lengths.size(), nullptr);
  for (const std::vector<PilotVertex>& tile : tiles)
    for (const PilotVertex& v : tile) {
      if (v.depth == 1) paths[v.pixel] = &v;
      pilot.lengths[v.pixel] = uint8_t(v.depth);
    }
  for (size_t pixel = 0; pixel < paths.size(); ++pixel)
    pilot.vertices.insert(pilot.vertices.end(), paths[pixel], paths[pixel] + pilot.lengths[pixel]);
}

}  // namespace

Pilot tracePilot(const render::Scene& scene, const render::LightSampler& lights, uint64_t seed) {
  const render::Crop& crop = scene.film().crop;
  const size_t pixels = size_t(crop.width) * size_t(crop.height);
  render::Pass pass;
  pass.path.scene = &scene;
  pass.path.lights = &lights;
  pass.path.maxDepth = kDeepestPath;
  pass.seed = seed;
  pass.samples = [](uint32_t) { return std::pair(0u, 1u); };
  std::vector<render::PixelSums> image(pixels);
  render::Records records;
  pass.image = &image;
  pass.records = &records;
  render::Progress silent;
  render::runPass(pass, silent, [] { return false; });

  Pilot pilot;
  pilot.lengths.assign(pixels, 0);
  sortByPixel(records, pilot);
  for (const render::PixelSums& sums : image)
    pilot.image.emplace_back(float(sums.sum.x), float(sums.sum.y), float(sums.sum.z));
  pilot.sampleWeight.assign(pixels, 1);
  for (const PilotVertex& v : pilot.vertices) pilot.sampleWeight[v.pixel] = v.sampleWeight;
  return pilot;
}

ViewFrame frameOf(std::span<const Pilot> pilots) {
  std::vector<std::span<const PilotVertex>> parts;
  double sum = 0;
  size_t pixels = 0;
  for (const Pilot& pilot : pilots) {
    parts.emplace_back(pilot.vertices);
    for (const render::Rgb& c : pilot.image) sum += render::luminance(c);
    pixels += pilot.image.size();
  }
  CellStore cells(INFINITY);
  cells.add(parts, GuideOptions().cellsPerDiagonal);
  ViewFrame frame{cells.grid().origin(), cells.grid().finestEdge(), 1};
  const double mean = sum / double(std::max<size_t>(pixels, 1));
  if (mean > 0 && std::isfinite(mean)) frame.unit = float(mean);
  return frame;
}

}  // namespace odis::learn
