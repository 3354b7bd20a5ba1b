#include "odis/pixels/pixel_maps.h"

#include <algorithm>
#include <cmath>

namespace odis::core {

namespace {

// A square of pixels, cut off at the image's border.
struct Tile {
  int x0, y0, x1, y1;
};

class TileGrid {
 public:
  TileGrid(const FirstVertices& vertices, int size)
      : m_vertices(vertices),
        m_size(size),
        m_columns((vertices.width() + size - 1) / size),
        m_rows((vertices.height() + size - 1) / size) {}

  int columns() const { return m_columns; }
  int rows() const { return m_rows; }
  size_t count() const { return size_t(m_columns) * size_t(m_rows); }
  Tile tile(int column, int row) const {
    return {column * m_size, row * m_size, std::min((column + 1) * m_size, m_vertices.width()),
            std::min((row + 1) * m_size, m_vertices.height())};
  }
  // The first vertex nearest to the middle; null if the tile has none.
  const FirstVertex* middle(const Tile& tile) const {
    const FirstVertex* best = nullptr;
    int least = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) {
        const FirstVertex& v = m_vertices.at(x, y);
        const int dx = 2 * x + 1 - tile.x0 - tile.x1, dy = 2 * y + 1 - tile.y0 - tile.y1;
        if (!v.there || (best && dx * dx + dy * dy >= least)) continue;
        best = &v;
        least = dx * dx + dy * dy;
      }
    return best;
  }

 private:
  const FirstVertices& m_vertices;
  int m_size, m_columns, m_rows;
};

// How unlike two surfaces are: the distance to the place's plane, and to the place, as fractions of how far
// it lies from its neighbours, and how far the normals are apart.
float unlikeness(const FirstVertex& v, const PixelMaps::Place& place, float extent) {
  const Float3 offset = v.position - place.position;
  const float scale = extent > 0 ? 1 / extent : 0;
  return std::abs(dot(offset, place.normal)) * scale + 0.1f * std::sqrt(dot(offset, offset)) * scale +
         4 * (1 - dot(v.normal, place.normal));
}

// The map of a pixel among those of the tiles around; the tile's own where the pixel has no vertex to judge
// by.
uint32_t mapOfPixel(const TileGrid& grid, const std::vector<uint32_t>& mapOf, const PixelMaps& maps,
                    const FirstVertex& v, int column, int row) {
  const auto at = [&](int x, int y) { return mapOf[size_t(y) * size_t(grid.columns()) + size_t(x)]; };
  const uint32_t own = at(column, row);
  uint32_t best = own;
  float least = INFINITY;
  float extent = 0;
  const int x0 = std::max(column - 1, 0), x1 = std::min(column + 1, grid.columns() - 1);
  const int y0 = std::max(row - 1, 0), y1 = std::min(row + 1, grid.rows() - 1);
  for (int pass = 0; pass < 2; ++pass)
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const uint32_t map = at(x, y);
        if (map == kNoMap) continue;
        if (best == kNoMap) best = map;
        if (!v.there) continue;
        const PixelMaps::Place& place = maps.places[map];
        if (pass == 0) {
          const Float3 offset = v.position - place.position;
          const float distance = std::sqrt(dot(offset, offset));
          extent = extent > 0 && distance > 0 ? std::min(extent, distance) : std::max(extent, distance);
          continue;
        }
        const float unlike = unlikeness(v, place, extent) + (map == own ? 0 : 0.5f);
        if (unlike >= least) continue;
        least = unlike;
        best = map;
      }
  return best;
}

}  // namespace

void PixelMaps::setRadiance(size_t map, const Histogram& radiance) {
  const float brightest = *std::max_element(radiance.begin(), radiance.end());
  const float scale = brightest > 0 ? 65535 / brightest : 0;
  for (size_t t = 0; t < kMapTexels; ++t)
    texels[map * kMapTexels + t] = uint16_t(std::max(1.0f, scale * radiance[t] + 0.5f));
}

Histogram PixelMaps::radiance(size_t map) const {
  Histogram result;
  std::copy_n(&texels[map * kMapTexels], kMapTexels, result.begin());
  return result;
}

PixelMaps makePixelMaps(const FirstVertices& vertices, int tile, const PixelModel& model, const Tasks& tasks,
                        const Progress& progress) {
  const TileGrid grid(vertices, tile);
  PixelMaps maps;
  std::vector<PixelPlace> places;
  std::vector<uint32_t> mapOf(grid.count(), kNoMap);
  for (int row = 0; row < grid.rows(); ++row)
    for (int column = 0; column < grid.columns(); ++column) {
      const Tile t = grid.tile(column, row);
      const FirstVertex* v = grid.middle(t);
      if (!v) continue;
      mapOf[size_t(row) * size_t(grid.columns()) + size_t(column)] = uint32_t(places.size());
      places.push_back({v->position, v->normal, v->roughness, v->albedo, t.x0, t.y0, tile});
      maps.places.push_back({v->position, v->normal});
    }

  // Batch by batch, in portions that progress is told of in between.
  maps.texels.resize(places.size() * kMapTexels);
  const size_t batches = (places.size() + kPixelBatch - 1) / kPixelBatch;
  constexpr size_t kPortion = 256;
  for (size_t first = 0; first < batches; first += kPortion) {
    progress.report(double(first) / double(batches));
    tasks.forEach(std::min(kPortion, batches - first), [&](size_t batch) {
      thread_local std::vector<Neighbourhood> seen(kPixelBatch);
      thread_local std::vector<Histogram> radiance(kPixelBatch);
      const size_t begin = (first + batch) * kPixelBatch,
                   count = std::min(kPixelBatch, places.size() - begin);
      for (size_t i = 0; i < count; ++i) look(vertices, places[begin + i], seen[i]);
      model.predict(count, seen.data(), &places[begin], radiance.data());
      for (size_t i = 0; i < count; ++i) maps.setRadiance(begin + i, radiance[i]);
    });
  }

  maps.ofPixel.assign(size_t(vertices.width()) * size_t(vertices.height()), kNoMap);
  tasks.forEach(size_t(vertices.height()), [&](size_t y) {
    for (int x = 0; x < vertices.width(); ++x)
      maps.ofPixel[y * size_t(vertices.width()) + size_t(x)] =
          mapOfPixel(grid, mapOf, maps, vertices.at(x, int(y)), x / tile, int(y) / tile);
  });
  return maps;
}

void PixelOracle::add(ArrayView<const PathVertex> vertices) {
  uint32_t lastPixel = ~0u, lastSample = ~0u;
  for (const PathVertex& v : vertices) {
    if (v.pixel >= m_pixels.size() || !mayBeGuided(v)) continue;
    if (v.pixel == lastPixel && v.sample == lastSample) continue;  // beyond the path's first vertex
    lastPixel = v.pixel;
    lastSample = v.sample;
    if (isInMedium(v)) continue;
    const FirstVertex first = describeFirst(v, m_radiance);
    Pixel& pixel = m_pixels[v.pixel];
    ++pixel.count;
    pixel.position = pixel.position + first.position;
    pixel.normal = pixel.normal + first.normal;
    if (!(first.pdf > 0)) continue;
    const Splat texels = splat(first.wi);
    for (int i = 0; i < 4; ++i)
      pixel.energy[size_t(texels.texel[i])] += texels.weight[i] * first.radiance / first.pdf;
  }
}

PixelMaps PixelOracle::maps(const Tasks& tasks) const {
  PixelMaps maps;
  for (const Pixel& pixel : m_pixels) {
    maps.ofPixel.push_back(pixel.count > 0 ? uint32_t(maps.places.size()) : kNoMap);
    if (!(pixel.count > 0)) continue;
    const float length = std::sqrt(dot(pixel.normal, pixel.normal));
    maps.places.push_back(
        {pixel.position / pixel.count, length > 0 ? pixel.normal / length : Float3{0, 0, 1}});
  }
  maps.texels.resize(maps.size() * kMapTexels);
  tasks.forEach(size_t(m_height), [&](size_t y) {
    for (size_t p = y * size_t(m_width); p < (y + 1) * size_t(m_width); ++p)
      if (maps.ofPixel[p] != kNoMap) maps.setRadiance(maps.ofPixel[p], m_pixels[p].energy);
  });
  return maps;
}

}  // namespace odis::core
