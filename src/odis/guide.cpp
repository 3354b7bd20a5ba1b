#include "odis/guide.h"

#include "odis/cells/statistics.h"
#include "odis/decisions/choose_alphas.h"
#include "odis/decisions/direction_model.h"
#include "odis/decisions/lights.h"
#include "odis/decisions/pack.h"
#include "odis/decisions/roulette.h"

namespace odis {

struct Guide::Data {
  CellGrid grid;
  CellIndex index;
  std::vector<Cell> cells;
  std::vector<float> lights;  // tables of lightGroups + 1 entries for each cell
  uint32_t lightGroups = 0;
  AlphaPrediction predicted;

  const float* lightTable(const Cell& cell) const {
    return &lights[size_t(&cell - cells.data()) * size_t(lightGroups + 1)];
  }
};

Guide::Guide() = default;
Guide::~Guide() = default;
Guide::Guide(Guide&&) noexcept = default;
Guide& Guide::operator=(Guide&&) noexcept = default;

const Cell* Guide::find(const Float3& position, const Float3& normal) const {
  if (!m_data) return nullptr;
  for (int level = 0; level < kCellLevels; ++level) {
    const uint32_t index = m_data->index.find(m_data->grid.key(position, normal, level));
    if (index != kNoCell) return &m_data->cells[index];
  }
  return nullptr;
}

void Guide::find(std::span<const Place> places, std::span<const Cell*> cells) const {
  if (!m_data) {
    std::fill_n(cells.begin(), places.size(), nullptr);
    return;
  }
  thread_local std::vector<uint64_t> keys;
  keys.clear();
  for (const Place& place : places) {
    keys.push_back(m_data->grid.key(place.position, place.normal, 0));
    m_data->index.prefetch(keys.back());
  }
  for (size_t i = 0; i < places.size(); ++i) {
    // Neighbours in the list are often neighbours in the scene; places with the same key share all coarser cells, too.
    if (i > 0 && keys[i] == keys[i - 1]) {
      cells[i] = cells[i - 1];
      continue;
    }
    const uint32_t finest = m_data->index.find(keys[i]);
    cells[i] = finest != kNoCell ? &m_data->cells[finest] : find(places[i].position, places[i].normal);
  }
}

void Guide::prefetch(const Cell& cell) const {
  constexpr size_t kLine = 64;
  for (size_t byte = 0; byte < sizeof(Cell); byte += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(&cell) + byte);
  if (m_data->lights.empty()) return;
  const float* table = m_data->lightTable(cell);
  __builtin_prefetch(table);
  __builtin_prefetch(table + m_data->lightGroups);
}

LearnedLights Guide::lights(const Cell& cell) const {
  if (!(cell.lightShare > 0)) return {};
  return {m_data->lightTable(cell), cell.lightShare};
}

uint32_t Guide::indexOf(const Cell& cell) const {
  return uint32_t(&cell - m_data->cells.data());
}

uint64_t Guide::cellCount() const {
  return m_data ? m_data->cells.size() : 0;
}
uint64_t Guide::bytes() const {
  return m_data ? m_data->cells.size() * sizeof(Cell) + m_data->lights.size() * sizeof(float) +
                      m_data->index.bytes()
                : 0;
}
float Guide::predictedVarianceRatio() const {
  return m_data ? m_data->predicted.varianceRatio : 1;
}
std::span<const PixelPrediction> Guide::predictions() const {
  return m_data ? std::span<const PixelPrediction>(m_data->predicted.pixels)
                : std::span<const PixelPrediction>();
}

struct PilotDigest::Data {
  BatchSamples samples;
};

PilotDigest::PilotDigest() = default;
PilotDigest::~PilotDigest() = default;
PilotDigest::PilotDigest(PilotDigest&&) noexcept = default;
PilotDigest& PilotDigest::operator=(PilotDigest&&) noexcept = default;

struct GuideBuilder::Data {
  explicit Data(const GuideOptions& o)
      : options(withFormulas(o)), store(o.clamp, options.model->looksAround()) {}

  // Formulas where there is no model.
  static GuideOptions withFormulas(GuideOptions options) {
    if (!options.model) options.model = std::make_shared<HistogramModel>(options);
    if (!options.continuations) options.continuations = std::make_shared<ShrunkMoments>();
    if (!options.lights) options.lights = std::make_shared<ShrunkLightSquares>();
    return options;
  }
  GuideOptions options;
  CellStore store;
};

GuideBuilder::GuideBuilder(const GuideOptions& options) : m_data(std::make_unique<Data>(options)) {}
GuideBuilder::~GuideBuilder() = default;

void GuideBuilder::add(PilotParts parts) {
  m_data->store.add(parts, m_data->options.cellsPerDiagonal);
}
PilotDigest GuideBuilder::digest(std::span<const PilotVertex> vertices) const {
  PilotDigest digest;
  digest.m_data = std::make_unique<PilotDigest::Data>(PilotDigest::Data{m_data->store.take({vertices})});
  return digest;
}
void GuideBuilder::add(std::span<const PilotDigest> digests) {
  std::vector<const BatchSamples*> batches;
  for (const PilotDigest& digest : digests)
    if (digest.m_data) batches.push_back(&digest.m_data->samples);
  m_data->store.add(batches);
}
uint64_t GuideBuilder::bytes() const {
  // What `build` makes beside the cells' statistics: distributions, sums for the selection.
  constexpr uint64_t kPerCell = sizeof(DirectionDistribution) + 2 * sizeof(CellSelection);
  const CellStore& store = m_data->store;
  return store.bytes() + std::max(store.transientBytes(), store.index().size() * kPerCell);
}

// A guide of maps alone, made for coarse levels first; leaves the distributions that they were made from.
Guide GuideBuilder::buildMaps(const std::vector<CellStatistics>& cells,
                              std::vector<DirectionDistribution>& distributions) const {
  const GuideOptions& options = m_data->options;
  Guide guide;
  guide.m_data = std::make_unique<Guide::Data>();
  guide.m_data->grid = m_data->store.grid();
  guide.m_data->index = m_data->store.index();
  guide.m_data->cells.resize(cells.size());
  distributions.resize(cells.size());
  forEachFromCoarse(cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    distributions[c] =
        options.model->predict(chainOf(cells, c), parent == kNoCell ? nullptr : &distributions[parent]);
    guide.m_data->cells[c].map = pack(distributions[c], options.floor);
  });
  return guide;
}

void GuideBuilder::addRouletteAndLights(Guide& guide, const std::vector<CellStatistics>& cells) const {
  const GuideOptions& options = m_data->options;
  Guide::Data& result = *guide.m_data;
  weighContinuations(result.cells, cells, *options.continuations, result.predicted.totals,
                     options.controlVariate);
  result.lightGroups = std::min(options.lightGroups, kMostLightGroups);
  if (result.lightGroups > 0)
    result.lights =
        tabulateLights(result.cells, cells, *options.lights, result.lightGroups, options.lightParts);
}

Guide GuideBuilder::build(PilotParts parts, std::span<const float> pixelValues) const {
  const GuideOptions& options = m_data->options;
  const std::vector<CellStatistics>& cells = m_data->store.rollUp();
  std::vector<DirectionDistribution> distributions;
  Guide guide = buildMaps(cells, distributions);
  std::vector<Cell>& result = guide.m_data->cells;

  // Selection probabilities.
  AlphaPrediction& predicted = guide.m_data->predicted =
      chooseAlphas(result, m_data->store, cells, distributions, parts, pixelValues);
  if (options.fixedAlpha > 0) {
    for (Cell& cell : result) std::fill(cell.alpha, cell.alpha + kMaterialClasses, options.fixedAlpha);
    predicted.varianceRatio = 1;
    predicted.pixels.clear();
  }

  addRouletteAndLights(guide, cells);
  return guide;
}

Guide GuideBuilder::rebuild(const Guide& previous) const {
  const std::vector<CellStatistics>& cells = m_data->store.rollUp();
  std::vector<DirectionDistribution> distributions;
  Guide guide = buildMaps(cells, distributions);
  std::vector<Cell>& result = guide.m_data->cells;

  // Old cells keep their indices, new ones follow.
  const std::vector<Cell>& old = previous.m_data->cells;
  forEachFromCoarse(cells, [&](size_t c) {
    if (c < old.size())
      std::copy_n(old[c].alpha, kMaterialClasses, result[c].alpha);
    else if (cells[c].parent != kNoCell)
      std::copy_n(result[cells[c].parent].alpha, kMaterialClasses, result[c].alpha);
  });
  guide.m_data->predicted = previous.m_data->predicted;
  addRouletteAndLights(guide, cells);
  return guide;
}

}  // namespace odis
