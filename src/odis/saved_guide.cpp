// Guides and builders written to a file and read again.
#include <cmath>

#include "odis/cells/saved_grid.h"
#include "odis/files/archive.h"
#include "odis/guide_data.h"
#include "odis/maps/pack.h"

namespace odis::core {

namespace {

// Whether a cell decides what a host can follow.
bool isSound(const CellDecisions& d) {
  for (const float fraction : d.bsdfFraction)
    if (!(fraction > 0 && fraction <= 1)) return false;
  const Float3& outgoing = d.outgoingRadiance;
  return d.survivalFactor >= 0 && std::isfinite(outgoing.x + outgoing.y + outgoing.z) &&
         d.learnedLightFraction >= 0 && d.learnedLightFraction < 1;
}

bool isSound(const CachedRadiance& c) {
  return std::isfinite(c.radiance.x + c.radiance.y + c.radiance.z) && c.error >= 0;
}

// Whether a table rises from 0 to 1, or to anything less where nothing is known.
bool isSound(std::span<const float> table, bool known) {
  if (known && (table.front() != 0 || table.back() != 1)) return false;
  for (size_t i = 0; i + 1 < table.size(); ++i)
    if (!(table[i] >= 0 && table[i] <= table[i + 1])) return false;
  return table.back() <= 1;
}

}  // namespace

void Guide::save(ArchiveWriter& file) const {
  file.addValue("guide.built", uint8_t(m_data != nullptr));
  if (!m_data) return;
  const size_t cells = m_data->decisions.size();
  saveGrid(file, "guide.grid", m_data->grid.flat());
  file.add("guide.keys", m_data->keys);
  file.add("guide.texels", std::span<const uint16_t>(m_data->texels.data(), cells * kMapTexels));
  file.add("guide.decisions", m_data->decisions);
  file.addValue("guide.lightGroups", m_data->lightGroups);
  file.add("guide.lightTables", m_data->lightTables);
  file.add("guide.cached", m_data->cached);
  file.addValue("guide.cachedError", m_data->cachedError);
  file.addValue("guide.maxDepth", m_data->maxDepth);
  file.add("guide.cachedShares", m_data->cachedShares);
  file.addValue("guide.prediction", m_data->prediction);
  file.add("guide.pixelCells", m_data->pixelCells);
  file.addValue("guide.rim", m_data->rim);
  file.addValue("guide.gridCells", m_data->index.size());
}

Guide Guide::load(const Archive& file) {
  Guide guide;
  if (!file.value<uint8_t>("guide.built")) return guide;
  const std::vector<uint64_t> keys = file.get<uint64_t>("guide.keys");
  const std::vector<uint16_t> texels = file.get<uint16_t>("guide.texels", keys.size() * kMapTexels);
  file.require(std::find(texels.begin(), texels.end(), uint16_t(0)) == texels.end(),
               "guide.texels: a direction is impossible");
  guide.m_data = std::make_shared<Data>(keys.size());
  Data& data = *guide.m_data;
  data.grid = CellGrid(loadGrid(file, "guide.grid"));
  data.keys = keys;
  // Guides without maps at pixels may lack what belongs to these.
  const bool pixels = file.contains("guide.pixelCells");
  const uint32_t gridCells = pixels ? file.value<uint32_t>("guide.gridCells") : uint32_t(keys.size());
  file.require(gridCells <= keys.size(), "guide.gridCells: is damaged");
  for (uint32_t c = 0; c < keys.size(); ++c)
    file.require(
        CellGrid::levelOf(keys[c]) < kCellLevels && (c >= gridCells || data.index.insert(keys[c]) == c),
        "guide.keys: are damaged");
  if (pixels) {
    data.rim = file.value<float>("guide.rim");
    // Any other might leave a map nothing to sample.
    file.require(data.rim == MapArrays().rim || data.rim == Data::kRimWithoutProduct,
                 "guide.rim: is damaged");
    data.pixelCells = file.get<uint32_t>("guide.pixelCells");
    for (const uint32_t cell : data.pixelCells)
      file.require(cell == kNoCell || cell < keys.size(), "guide.pixelCells: are damaged");
  }
  std::copy(texels.begin(), texels.end(), data.texels.at(0));
  for (size_t c = 0; c < keys.size(); ++c)
    sumBlocks(data.texels.at(c * kMapTexels), data.sums.at(c * kSumsPerMap));
  data.decisions = file.get<CellDecisions>("guide.decisions", keys.size());
  data.lightGroups = file.value<uint32_t>("guide.lightGroups");
  file.require(data.lightGroups <= kMaxLightGroups, "guide.lightGroups: is damaged");
  const size_t columns = data.lightGroups + 1;
  data.lightTables = file.get<float>("guide.lightTables", data.lightGroups > 0 ? keys.size() * columns : 0);
  for (size_t c = 0; c < keys.size(); ++c) {
    const bool hasTable = data.decisions[c].learnedLightFraction > 0;
    file.require(isSound(data.decisions[c]) && (data.lightGroups > 0 || !hasTable),
                 "guide.decisions: are damaged");
    if (data.lightGroups > 0)
      file.require(isSound(std::span<const float>(&data.lightTables[c * columns], columns), hasTable),
                   "guide.lightTables: are damaged");
  }
  if (file.contains("guide.cached")) {
    data.cachedError = file.value<float>("guide.cachedError");
    data.cached = file.get<CachedRadiance>("guide.cached", data.cachedError > 0 ? 2 * keys.size() : 0);
    for (const CachedRadiance& cached : data.cached)
      file.require(isSound(cached), "guide.cached: is damaged");
  }
  if (file.contains("guide.cachedShares")) {
    data.maxDepth = file.value<uint32_t>("guide.maxDepth");
    data.cachedShares = file.get<float>("guide.cachedShares");
    for (const float share : data.cachedShares)
      file.require(share >= 0 && share <= 1, "guide.cachedShares: are damaged");
  }
  data.prediction = file.value<GuidingPrediction>("guide.prediction");
  return guide;
}

void GuideBuilder::save(ArchiveWriter& file) const {
  m_data->store.save(file);
}

void GuideBuilder::load(const Archive& file) {
  m_data->store.load(file);
}

void GuideBuilder::adopt(Guide& guide) const {
  if (!guide.m_data) return;
  guide.m_data->builder = m_data.get();
  guide.m_data->numbering = m_data->store.numbering();
}

}  // namespace odis::core
