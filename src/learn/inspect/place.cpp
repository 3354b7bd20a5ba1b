#include "learn/inspect/place.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/path/pass.h"

namespace odis::learn {

using render::OptionError;

namespace {

float distance(const Float3& a, const Float3& b) {
  const Float3 offset = a - b;
  return std::sqrt(dot(offset, offset));
}

std::string text(const Float3& v) {
  return fmt::format("{:.4g},{:.4g},{:.4g}", v.x, v.y, v.z);
}

[[noreturn]] void failNear(std::span<const PathVertex> pilot, const CellGrid& grid, const Float3& point,
                           const char* facing) {
  const PathVertex* nearest = nullptr;
  for (const PathVertex& v : pilot)
    if (isUsable(v) && (!nearest || distance(v.position, point) < distance(nearest->position, point)))
      nearest = &v;
  const float widest = grid.edge(grid.key(point, {}, kCellLevels - 1));
  throw OptionError(fmt::format(
      "--point: the pilot saw nothing{} in the cells at {}, the widest of which is {:.4g} wide; {}", facing,
      text(point), widest,
      nearest ? fmt::format("the nearest place that it saw is {}, {:.4g} away", text(nearest->position),
                            distance(nearest->position, point))
              : "it saw nothing anywhere"));
}

}  // namespace

InspectedPlace placeOfPixel(const render::Scene& scene, const render::LightSampler& lights,
                            const render::RenderOptions& options, render::Vec2i pixel) {
  const render::FilmSettings& film = scene.film();
  const render::Crop& crop = film.crop;
  if (pixel.x < crop.x || pixel.y < crop.y || pixel.x >= crop.x + crop.width ||
      pixel.y >= crop.y + crop.height)
    throw OptionError(
        fmt::format("--pixel: {},{} is outside of the image, expected x from {} to {} and y from {} to {}",
                    pixel.x, pixel.y, crop.x, crop.x + crop.width - 1, crop.y, crop.y + crop.height - 1));
  render::PathSettings settings;
  settings.scene = &scene;
  settings.lights = &lights;
  settings.maxDepth = options.maxDepth;
  settings.rrDepth = options.rrDepth;
  const render::Sampler sampler(options.sampler, options.seed, uint32_t(pixel.y * film.width + pixel.x), 0);
  const render::CameraRay camera =
      render::cameraRay(scene, render::FilmKind::pixels, pixel, render::cameraNumbers(scene, sampler));
  render::Path path(camera.ray, sampler);
  std::vector<PathVertex> vertices;
  render::tracePaths(settings, std::span(&path, 1), &vertices);
  for (size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].pixel = uint32_t((pixel.y - crop.y) * crop.width + pixel.x - crop.x);
    if (!(vertices[i].guidableProbability > 0)) continue;
    const auto start = findStart(scene, vertices, i);
    if (start) return {vertices[i], *start, vertices[i].position, vertices[i].normal};
  }
  throw OptionError(
      fmt::format("--pixel: the path through {},{} meets nothing that may be guided: {}", pixel.x, pixel.y,
                  vertices.empty() ? "it scatters nowhere" : "its surfaces are too sharp, or absorb all"));
}

uint32_t finestCell(const core::CellStore& store, const Float3& position, const Float3& normal) {
  for (int level = 0; level < kCellLevels; ++level) {
    const uint32_t cell = store.index().find(store.grid().key(position, normal, level));
    if (cell != kNoCell) return cell;
  }
  return kNoCell;
}

std::vector<size_t> membersOf(std::span<const PathVertex> pilot, const CellGrid& grid, uint64_t key,
                              int level) {
  std::vector<size_t> members;
  for (size_t i = 0; i < pilot.size(); ++i)
    if (isUsable(pilot[i]) && grid.key(pilot[i].position, pilot[i].normal, level) == key)
      members.push_back(i);
  return members;
}

InspectedPlace placeAtPoint(const render::Scene& scene, std::span<const PathVertex> pilot,
                            const core::CellStore& store, std::span<const core::CellStatistics> cells,
                            const Float3& point, const std::optional<Float3>& normal) {
  // Cells are split by the axis that normals are nearest to: without a normal, all six are asked.
  std::vector<Float3> normals{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  if (normal) normals = {*normal};
  const Float3* facing = nullptr;
  uint32_t found = kNoCell;
  for (const Float3& n : normals) {
    const uint32_t cell = finestCell(store, point, n);
    if (cell == kNoCell) continue;
    if (found == kNoCell || cells[cell].level < cells[found].level ||
        (cells[cell].level == cells[found].level && cells[cell].count > cells[found].count)) {
      found = cell;
      facing = &n;
    }
  }
  if (found == kNoCell) failNear(pilot, store.grid(), point, normal ? " that faces this way" : "");

  const int level = cells[found].level;
  std::vector<size_t> members =
      membersOf(pilot, store.grid(), store.grid().key(point, *facing, level), level);
  std::stable_sort(members.begin(), members.end(), [&](size_t a, size_t b) {
    const bool guidableA = pilot[a].guidableProbability > 0, guidableB = pilot[b].guidableProbability > 0;
    if (guidableA != guidableB) return guidableA;
    return distance(pilot[a].position, point) < distance(pilot[b].position, point);
  });
  for (const size_t i : members) {
    const auto start = findStart(scene, pilot, i);
    if (start) return {pilot[i], *start, point, *facing};
  }
  throw OptionError(
      fmt::format("--point: none of the vertices in the cell at {} is found again", text(point)));
}

}  // namespace odis::learn
