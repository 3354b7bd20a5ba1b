// Guides and builders written to a file and read again.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "odis/cells/saved_grid.h"
#include "odis/files/archive.h"
#include "odis/guide_data.h"
#include "odis/options/settings.h"

namespace odis::core {

template <class Body>
constexpr void forEachField(FieldsOf<CellDecisions>, const Body& body) {
  body("bsdfFraction", &CellDecisions::bsdfFraction);
  body("survivalFactor", &CellDecisions::survivalFactor);
  body("outgoingRadiance", &CellDecisions::outgoingRadiance);
  body("learnedLightFraction", &CellDecisions::learnedLightFraction);
}
static_assert(listedBytes<CellDecisions>() == sizeof(CellDecisions));

template <class Body>
constexpr void forEachField(FieldsOf<CachedRadiance>, const Body& body) {
  body("radiance", &CachedRadiance::radiance);
  body("error", &CachedRadiance::error);
}
static_assert(listedBytes<CachedRadiance>() == sizeof(CachedRadiance));

template <class Body>
constexpr void forEachField(FieldsOf<ImageMoments>, const Body& body) {
  body("variance", &ImageMoments::variance);
  body("rays", &ImageMoments::rays);
  body("count", &ImageMoments::count);
}
static_assert(listedBytes<ImageMoments>() == sizeof(ImageMoments));

template <class Body>
constexpr void forEachField(FieldsOf<LightParts>, const Body& body) {
  body("first", &LightParts::first);
  body("count", &LightParts::count);
}

namespace {

// Whether the shares of a table of a map are positive and add up to the whole.
bool isSound(std::span<const uint16_t> shares) {
  return std::find(shares.begin(), shares.end(), 0) == shares.end() &&
         std::accumulate(shares.begin(), shares.end(), 0) == kWhole;
}

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

std::vector<uint64_t> loadKeys(const Archive& file) {
  std::vector<uint64_t> keys = file.get<uint64_t>("guide.keys");
  file.require(keys.size() <= kMostMaps, "guide.keys: are too many");
  return keys;
}

}  // namespace

void Guide::save(ArchiveWriter& file) const {
  file.addValue("guide.built", uint8_t(m_data != nullptr));
  if (!m_data) return;
  const size_t cells = m_data->decisions.size();
  saveGrid(file, "guide.grid", m_data->grid.flat());
  file.add("guide.keys", m_data->keys);
  file.add("guide.maps", std::span<const uint16_t>(m_data->maps.data(), cells * kMapShares));
  saveFields(file, "guide.decisions", m_data->decisions);
  file.addValue("guide.lightGroups", m_data->lightGroups);
  file.addValue("guide.lightDecider", m_data->lightDecider);
  file.add("guide.lightTables", m_data->lightTables);
  saveFields(file, "guide.cached", m_data->cached);
  file.addValue("guide.cachedError", m_data->cachedError);
  file.addValue("guide.maxDepth", m_data->maxDepth);
  file.add("guide.cachedShares", m_data->cachedShares);
  saveFields(file, "guide.prediction", m_data->prediction.image);
  file.addValue("guide.varianceRatio", m_data->prediction.varianceRatio);
  file.add("guide.pixelCells", m_data->pixelCells);
  file.addValue("guide.gridCells", m_data->index.size());
}

Guide Guide::load(const Archive& file) {
  Guide guide;
  if (!file.value<uint8_t>("guide.built")) return guide;
  const std::vector<uint64_t> keys = loadKeys(file);
  const std::vector<uint16_t> maps = file.get<uint16_t>("guide.maps", keys.size() * kMapShares);
  for (size_t table = 0; table < maps.size(); table += kBlockTexels)
    file.require(isSound(std::span(maps).subspan(table, kBlockTexels)), "guide.maps: are damaged");
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
    data.pixelCells = file.get<uint32_t>("guide.pixelCells");
    for (const uint32_t cell : data.pixelCells)
      file.require(cell == kNoCell || cell < keys.size(), "guide.pixelCells: are damaged");
  }
  std::copy(maps.begin(), maps.end(), data.mapAt(0));
  data.decisions = loadFields<CellDecisions>(file, "guide.decisions", keys.size());
  data.lightGroups = file.value<uint32_t>("guide.lightGroups");
  file.require(data.lightGroups <= kMaxLightGroups, "guide.lightGroups: is damaged");
  if (file.contains("guide.lightDecider")) data.lightDecider = file.value<LightDecider>("guide.lightDecider");
  file.require(data.lightDecider <= LightDecider::model, "guide.lightDecider: is damaged");
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
  data.cachedError = file.valueOr<float>("guide.cachedError", 0);
  if (data.cachedError > 0) {
    data.cached = loadFields<CachedRadiance>(file, "guide.cached", 2 * keys.size());
    for (const CachedRadiance& cached : data.cached)
      file.require(isSound(cached), "guide.cached: is damaged");
  }
  if (file.contains("guide.cachedShares")) {
    data.maxDepth = file.value<uint32_t>("guide.maxDepth");
    data.cachedShares = file.get<float>("guide.cachedShares");
    for (const float share : data.cachedShares)
      file.require(share >= 0 && share <= 1, "guide.cachedShares: are damaged");
  }
  data.prediction.image = loadFieldsOfOne<ImageMoments>(file, "guide.prediction");
  data.prediction.varianceRatio = file.valueOr<float>("guide.varianceRatio", 1);
  return guide;
}

void GuideBuilder::save(ArchiveWriter& file) const {
  const Data& d = *m_data;
  file.addText("builder.settings", settingsText(d.options));
  file.addValue("builder.lightGroups", d.options.lightGroups);
  saveFields(file, "builder.lightParts", d.options.lightParts);
  file.addValue("builder.model", d.modelId);
  file.addValue("builder.own", d.id);
  std::vector<uint64_t> ids;
  for (const auto& [id, part] : d.parts) {
    const std::string name = "part" + std::to_string(ids.size());
    ids.push_back(id);
    part.store.save(file, name + ".cells");
    file.addValue(name + ".seen", part.fractions.seen);
    saveFields(file, name + ".fractions", part.fractions.samples);
  }
  file.add("builder.parts", ids);
}

void GuideBuilder::load(const Archive& file) {
  Data& d = *m_data;
  std::map<uint64_t, BuilderPart> parts;
  const std::vector<uint64_t> ids = file.get<uint64_t>("builder.parts");
  const CellGrid* grid = nullptr;
  for (size_t i = 0; i < ids.size(); ++i) {
    const std::string name = "part" + std::to_string(i);
    const auto [place, isNew] = parts.emplace(ids[i], BuilderPart{d.newStore(), {}});
    BuilderPart& part = place->second;
    part.store.load(file, name + ".cells");
    part.fractions.seen = file.value<uint64_t>(name + ".seen");
    part.fractions.samples = loadFields<FractionSample>(file, name + ".fractions");
    file.require(isNew, "builder.parts: are damaged");
    if (!part.store.isPlaced()) continue;
    file.require(!grid || part.store.grid() == *grid, "builder.parts: have different grids");
    grid = &part.store.grid();
  }
  d.id = file.value<uint64_t>("builder.own");
  file.require(parts.count(d.id) > 0, "builder.own: is damaged");
  d.parts = std::move(parts);
}

GuideOptions loadGuideOptions(const Archive& file) {
  FrameOptions options;
  try {
    applySettings(options, file.text("builder.settings"));
  } catch (const std::invalid_argument& error) {
    file.require(false, std::string("builder.settings: ") + error.what());
  }
  options.guide.lightGroups = file.valueOr<uint32_t>("builder.lightGroups", 0);
  options.guide.lightParts = loadFields<LightParts>(file, "builder.lightParts");
  return options.guide;
}

GuideBuilder GuideBuilder::load(const Archive& file, std::optional<Model> model,
                                std::shared_ptr<const Tasks> tasks) {
  file.requireKind("builder");
  GuideOptions options = loadGuideOptions(file);
  options.model = std::move(model);
  try {
    GuideBuilder builder(options, std::move(tasks));
    file.require(builder.modelId() == file.value<uint64_t>("builder.model"), "was saved with another model");
    builder.load(file);
    return builder;
  } catch (const std::invalid_argument& error) {
    file.require(false, error.what());
    throw;
  }
}

}  // namespace odis::core
