#include "odis/image/tiles.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace odis::core {

namespace {

constexpr uint32_t kTileSize = 16;

}  // namespace

TileCollector::TileCollector(uint32_t width, uint32_t height)
    : m_width(width),
      m_height(height),
      m_columns((width + kTileSize - 1) / kTileSize),
      m_rows((height + kTileSize - 1) / kTileSize),
      m_tiles(std::make_unique<Tile[]>(tileCount())) {}

uint32_t TileCollector::tileOf(uint32_t pixel) const {
  return pixel / m_width / kTileSize * m_columns + pixel % m_width / kTileSize;
}

uint32_t TileCollector::placeInTile(uint32_t pixel) const {
  const uint32_t x = pixel % m_width % kTileSize, y = pixel / m_width % kTileSize;
  return ((y / 4) * 4 + x / 4) * 16 + (y % 4) * 4 + x % 4;
}

bool TileCollector::isDue(uint32_t pixel, uint32_t sample) const {
  if (pixel >= m_width * m_height) return false;
  const SampleRange range = m_due(pixel);
  return sample >= range.first && sample - range.first < range.count;
}

uint64_t TileCollector::samplesDue(uint32_t tile) const {
  const uint32_t x0 = tile % m_columns * kTileSize, y0 = tile / m_columns * kTileSize;
  uint64_t due = 0;
  for (uint32_t y = y0; y < std::min(y0 + kTileSize, m_height); ++y)
    for (uint32_t x = x0; x < std::min(x0 + kTileSize, m_width); ++x) due += m_due(y * m_width + x).count;
  return due;
}

void TileCollector::beginPass(Due due, Sink sink) {
  m_due = std::move(due);
  m_sink = std::move(sink);
  m_refused = 0;
  for (uint32_t t = 0; t < tileCount(); ++t) {
    m_tiles[t].due = 0;
    m_tiles[t].done = false;
  }
}

// Whether all samples and vertices are of this tile and due.
bool TileCollector::allIn(uint32_t tile, ArrayView<const FrameSample> samples,
                          ArrayView<const PathVertex> vertices) const {
  for (const FrameSample& s : samples)
    if (s.pixel >= m_width * m_height || tileOf(s.pixel) != tile) return false;
  uint32_t pixel = ~0u, sample = 0;
  for (const PathVertex& v : vertices) {
    if (v.pixel == pixel && v.sample == sample) continue;
    if (!isDue(v.pixel, v.sample) || tileOf(v.pixel) != tile) return false;
    pixel = v.pixel;
    sample = v.sample;
  }
  return true;
}

void TileCollector::add(ArrayView<const FrameSample> samples, ArrayView<const PathVertex> vertices) {
  for (const FrameSample& s : samples)
    if (!isDue(s.pixel, s.sample))
      throw std::out_of_range("odisAddSamples: sample " + std::to_string(s.sample) + " of pixel " +
                              std::to_string(s.pixel) +
                              " is not due in this pass: odisGetSamples says which are");
  // Whatever is of one tile needs no sorting by tile.
  if (!samples.empty())
    if (const uint32_t tile = tileOf(samples[0].pixel); allIn(tile, samples, vertices))
      return addToTile(tile, samples, vertices);
  std::map<uint32_t, std::pair<std::vector<FrameSample>, std::vector<PathVertex>>> tiles;
  uint64_t refused = 0;
  for (const FrameSample& s : samples) tiles[tileOf(s.pixel)].first.push_back(s);
  for (const PathVertex& v : vertices)
    if (isDue(v.pixel, v.sample))
      tiles[tileOf(v.pixel)].second.push_back(v);
    else
      ++refused;
  for (auto& [tile, part] : tiles) addToTile(tile, part.first, part.second);
  if (refused == 0) return;
  const std::lock_guard lock(m_refusedMutex);
  m_refused += refused;
}

void TileCollector::addToTile(uint32_t index, ArrayView<const FrameSample> samples,
                              ArrayView<const PathVertex> vertices) {
  Tile& tile = m_tiles[index];
  const std::lock_guard lock(tile.mutex);
  if (tile.done)
    throw std::logic_error("odisAddSamples: a sample or vertex came twice, or after its tile was complete");
  if (tile.due == 0) tile.due = samplesDue(index);
  const bool nothingWaits = tile.samples.empty() && tile.vertices.empty();
  tile.done = tile.samples.size() + samples.size() == tile.due;
  if (tile.done && nothingWaits) return handOn(index, samples, vertices);
  tile.samples.insert(tile.samples.end(), samples.begin(), samples.end());
  tile.vertices.insert(tile.vertices.end(), vertices.begin(), vertices.end());
  m_waitingBytes += samples.size() * sizeof(FrameSample) + vertices.size() * sizeof(PathVertex);
  if (tile.done) handOnWaiting(index);
}

void TileCollector::handOnWaiting(uint32_t index) {
  const std::vector<FrameSample> samples = std::exchange(m_tiles[index].samples, {});
  const std::vector<PathVertex> vertices = std::exchange(m_tiles[index].vertices, {});
  m_waitingBytes -= samples.size() * sizeof(FrameSample) + vertices.size() * sizeof(PathVertex);
  handOn(index, samples, vertices);
}

void TileCollector::skip(const std::vector<uint8_t>& done) {
  for (uint32_t t = 0; t < tileCount(); ++t) m_tiles[t].done = done[t] != 0;
}

std::vector<uint8_t> TileCollector::done() const {
  std::vector<uint8_t> done;
  for (uint32_t t = 0; t < tileCount(); ++t) done.push_back(m_tiles[t].done);
  return done;
}

uint64_t TileCollector::endPass() {
  for (uint32_t t = 0; t < tileCount(); ++t) {
    Tile& tile = m_tiles[t];
    if (tile.samples.empty() && tile.vertices.empty()) continue;
    handOnWaiting(t);
  }
  return m_refused;
}

void TileCollector::handOn(uint32_t tile, ArrayView<const FrameSample> samples,
                           ArrayView<const PathVertex> vertices) {
  // Sums over a pixel depend on the order of its own samples alone.
  uint32_t next[kTileSize * kTileSize] = {};
  bool inOrder = true;
  for (const FrameSample& s : samples) {
    uint32_t& least = next[placeInTile(s.pixel)];
    inOrder = inOrder && s.sample >= least;
    least = s.sample + 1;
  }
  std::vector<FrameSample> orderedSamples;
  if (!inOrder) {
    orderedSamples.assign(samples.begin(), samples.end());
    std::sort(orderedSamples.begin(), orderedSamples.end(), [](const FrameSample& a, const FrameSample& b) {
      return std::tie(a.pixel, a.sample) < std::tie(b.pixel, b.sample);
    });
    samples = orderedSamples;
  }
  const auto precedes = [this](const PathVertex& a, const PathVertex& b) {
    if (a.pixel != b.pixel) return placeInTile(a.pixel) < placeInTile(b.pixel);
    return std::tie(a.sample, a.depth) < std::tie(b.sample, b.depth);
  };
  std::vector<PathVertex> orderedVertices;
  if (!std::is_sorted(vertices.begin(), vertices.end(), precedes)) {
    orderedVertices.assign(vertices.begin(), vertices.end());
    std::stable_sort(orderedVertices.begin(), orderedVertices.end(), precedes);
    vertices = orderedVertices;
  }
  m_sink(tile, samples, vertices);
}

}  // namespace odis::core
