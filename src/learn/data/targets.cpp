#include "learn/data/targets.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "learn/data/target_tracer.h"
#include "learn/scenes/random.h"
#include "odis/cells/samples.h"

namespace odis::learn {

namespace {

// At how many vertices of a cell samples start, at most.
constexpr size_t kMostStarts = 256;

// All vertices of a view.
class Vertices {
 public:
  Vertices(const render::Scene& scene, std::span<const Pilot> pilots) : m_scene(scene), m_pilots(pilots) {}

  // Calls use(index, vertex) with every vertex; the index counts through all pilots.
  template <class Use>
  void forEach(const Use& use) const {
    uint32_t index = 0;
    for (const Pilot& pilot : m_pilots)
      for (const PathVertex& v : pilot.vertices) use(index++, v);
  }
  std::optional<Start> find(uint32_t index) const {
    const Pilot* pilot = m_pilots.data();
    for (; index >= pilot->vertices.size(); ++pilot) index -= uint32_t(pilot->vertices.size());
    return findStart(m_scene, pilot->vertices, index);
  }

 private:
  const render::Scene& m_scene;
  std::span<const Pilot> m_pilots;
};

// Puts the keys of a weighted draw without replacement in front, the first drawn first (Efraimidis and
// Spirakis 2006).
template <class Item>
void drawInOrder(std::vector<std::pair<double, Item>>& weighted, Random& random) {
  for (auto& [weight, item] : weighted) weight = std::log(std::max(random.unit(), 1e-300)) / weight;
  std::stable_sort(weighted.begin(), weighted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
}

}  // namespace

std::vector<Target> traceTargets(const render::Scene& scene, const render::LightSampler& lights,
                                 std::span<const Pilot> pilots, const ViewFrame& frame,
                                 const TargetSettings& settings, uint64_t seed) {
  const Vertices vertices(scene, pilots);
  const CellGrid grid(frame.origin, frame.edge);
  struct Members {
    std::vector<uint32_t> vertices;
    bool scatter = false;  // whether any does: there is nothing to decide on black surfaces
  };
  std::map<uint64_t, Members> cells;
  std::vector<std::pair<double, uint32_t>> pixels;  // the first usable vertex of each path
  uint64_t lastPath = ~0ull, path = 0;
  vertices.forEach([&](uint32_t index, const PathVertex& v) {
    if (v.depth == 1) ++path;
    if (!isUsable(v)) return;
    Members& members =
        cells[grid.key(positionOf(stepsOf(v.position, frame), frame), unpacked(packed(v.normal)), 0)];
    members.vertices.push_back(index);
    members.scatter |= luminance(v.weight) > 0;
    if (path != lastPath) pixels.emplace_back(1, index);
    lastPath = path;
  });

  Random random(seed);
  TargetTracer tracer(scene, lights, settings, seed);
  std::vector<Target> targets;
  std::vector<Start> starts;
  std::vector<std::pair<double, const std::vector<uint32_t>*>> weighted;
  for (const auto& [key, members] : cells)
    if (members.scatter) weighted.emplace_back(std::sqrt(double(members.vertices.size())), &members.vertices);
  drawInOrder(weighted, random);
  const auto wanted = size_t(settings.cells);
  for (size_t i = 0; i < weighted.size() && targets.size() < wanted; ++i) {
    std::vector<std::pair<double, uint32_t>> members;
    for (const uint32_t index : *weighted[i].second) members.emplace_back(1, index);
    drawInOrder(members, random);
    starts.clear();
    for (size_t m = 0; m < members.size() && starts.size() < kMostStarts; ++m)
      if (const auto start = vertices.find(members[m].second)) starts.push_back(*start);
    if (starts.empty()) continue;
    Target& target = targets.emplace_back();
    target.vertex = members.front().second;
    target.cellVertices = uint32_t(members.size());
    tracer.trace(starts, target);
  }

  drawInOrder(pixels, random);
  size_t left = size_t(settings.pixels);
  for (size_t i = 0; i < pixels.size() && left > 0; ++i) {
    const auto start = vertices.find(pixels[i].second);
    if (!start) continue;
    Target& target = targets.emplace_back();
    target.pixel = true;
    target.vertex = pixels[i].second;
    target.cellVertices = 1;
    tracer.trace(std::span(&*start, 1), target);
    --left;
  }
  return targets;
}

}  // namespace odis::learn
