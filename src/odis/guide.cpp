#include "odis/guide_data.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "odis/cells/place_grid.h"
#include "odis/cells/statistics.h"
#include "odis/cells/surroundings.h"
#include "odis/maps/pack.h"
#include "odis/maps/texel_directions.h"
#include "odis/models/bsdf_fraction.h"
#include "odis/models/cached_radiance.h"
#include "odis/models/direction_formula.h"
#include "odis/models/lights.h"
#include "odis/models/model.h"
#include "odis/models/returned_light.h"
#include "odis/paper_method.h"
#include "odis/work/progress.h"

namespace odis::core {

namespace {

// The options, if all are in their ranges.
const GuideOptions& checked(const GuideOptions& options) {
  if (options.lightGroups > kMaxLightGroups)
    throw std::invalid_argument("OdisGuideOptions.lightGroups: expected at most " +
                                std::to_string(kMaxLightGroups));
  for (const auto& [first, count] : options.lightParts)
    if (options.lightGroups > 0 && (first > options.lightGroups || count > options.lightGroups - first))
      throw std::invalid_argument("OdisGuideOptions.lightParts: expected groups below lightGroups");
  FrameOptions all;
  all.guide = options;
  requireRanges(all);
  return options;
}

// The model of some options: with formulas in place of networks where they ask for that.
Model modelOf(const GuideOptions& options) {
  Model model = options.model ? *options.model : Model::builtIn();
  if (options.guide != GuideKind::network) model.directions = nullptr;
  if (options.lights != LightChoiceKind::network) model.lights = nullptr;
  if (options.pixelMaps == PixelMapKind::network && !options.pixelNetwork.empty())
    model = model.withPixelNetwork(options.pixelNetwork);
  return model;
}

}  // namespace

Guide::Guide() = default;
Guide::~Guide() = default;
Guide::Guide(const Guide&) = default;
Guide::Guide(Guide&&) noexcept = default;
Guide& Guide::operator=(Guide other) noexcept {
  m_data.swap(other.m_data);
  return *this;
}

GuideView Guide::view() const {
  GuideView view;
  if (!m_data) return view;
  view.cellCount = uint32_t(m_data->decisions.size());
  view.lightGroups = m_data->lightGroups;
  view.grid = m_data->grid.flat();
  view.slots = m_data->index.slots();
  view.slotMask = m_data->index.mask();
  view.keys = m_data->keys.data();
  view.maps = m_data->maps();
  view.decisions = m_data->decisions.data();
  view.lightTables = m_data->lightTables.data();
  view.cached = m_data->cached.empty() ? nullptr : m_data->cached.data();
  view.rules.cachedError = m_data->cachedError;
  view.maxDepth = m_data->maxDepth;
  view.cachedShares = m_data->cachedShares.empty() ? nullptr : m_data->cachedShares.data();
  view.cachedShareCount = uint32_t(m_data->cachedShares.size());
  if (!m_data->pixelCells.empty())
    view.pixels = {m_data->pixelCells.data(), uint32_t(m_data->pixelCells.size())};
  return view;
}

uint64_t Guide::bytes() const {
  if (!m_data) return 0;
  return m_data->index.bytes() + m_data->keys.size() * sizeof(uint64_t) + m_data->sums.bytes() +
         m_data->texels.bytes() + m_data->decisions.size() * sizeof(CellDecisions) +
         m_data->lightTables.size() * sizeof(float) + m_data->pixelCells.size() * sizeof(uint32_t);
}
float Guide::predictedVarianceRatio() const {
  return m_data ? m_data->prediction.varianceRatio : 1;
}

double Guide::raysPerPath() const {
  if (!m_data || !(m_data->prediction.image.count > 0)) return 0;
  return m_data->prediction.image.rays / m_data->prediction.image.count;
}

VertexSamples::VertexSamples() = default;
VertexSamples::~VertexSamples() = default;
VertexSamples::VertexSamples(VertexSamples&&) noexcept = default;
VertexSamples& VertexSamples::operator=(VertexSamples&&) noexcept = default;

VertexCounts VertexSamples::counts() const {
  return m_data ? m_data->cells.counts : VertexCounts();
}
void VertexSamples::narrow(uint64_t seen) {
  if (!m_data) return;
  const uint32_t stride = fractionStride(seen);
  std::erase_if(m_data->fractions, [&](const FractionSample& v) { return !isForFractions(v.pixel, stride); });
  m_data->fractions.shrink_to_fit();
}
uint64_t VertexSamples::bytes() const {
  return m_data ? m_data->cells.bytes() + m_data->fractions.capacity() * sizeof(FractionSample) : 0;
}

GuideBuilder::GuideBuilder(const GuideOptions& options, std::shared_ptr<const Tasks> tasks) {
  Model model = modelOf(options);
  PaperMethod::check(options, model);
  m_data = std::make_unique<Data>(checked(options), std::move(model), std::move(tasks));
}
GuideBuilder::~GuideBuilder() = default;
GuideBuilder::GuideBuilder(GuideBuilder&&) noexcept = default;
GuideBuilder& GuideBuilder::operator=(GuideBuilder&&) noexcept = default;

void GuideBuilder::add(VertexParts parts) {
  if (m_data->options.cellsPerDiagonal == 0) return;
  m_data->store.add(parts, m_data->options.cellsPerDiagonal, m_data->rules(false));
}
VertexSamples GuideBuilder::take(ArrayView<const PathVertex> vertices) const {
  if (m_data->options.cellsPerDiagonal == 0) return {};
  VertexSamples result;
  result.m_data = std::make_unique<VertexSamples::Data>(
      VertexSamples::Data{m_data->store.take({vertices}, m_data->rules(false)), {}});
  return result;
}
VertexSamples GuideBuilder::takeUnguided(ArrayView<const PathVertex> vertices, uint64_t seen) const {
  if (m_data->options.cellsPerDiagonal == 0) return {};
  VertexSamples result;
  const VertexRules rules = m_data->rules(true);
  BatchSamples cells = m_data->store.takeWithoutCells({vertices}, rules);
  const bool areUsable = refusedVertices(cells.counts) == cells.counts.discrete;
  result.m_data = std::make_unique<VertexSamples::Data>(VertexSamples::Data{
      std::move(cells), takeFractionSamples(vertices, fractionStride(seen), areUsable ? nullptr : &rules)});
  return result;
}
void GuideBuilder::add(ArrayView<VertexSamples> samples) {
  if (m_data->options.cellsPerDiagonal == 0) return;
  std::vector<BatchSamples*> batches;
  for (VertexSamples& batch : samples)
    if (batch.m_data) batches.push_back(&batch.m_data->cells);
  m_data->store.add(batches, m_data->options.cellsPerDiagonal);
  for (BatchSamples* batch : batches) batch->release();
}

void GuideBuilder::fade(float weight) {
  if (!(weight >= 0 && weight <= 1))
    throw std::invalid_argument("odisFadeVertices: weight: expected a number from 0 to 1");
  m_data->store.fade(weight);
}
void GuideBuilder::forget() {
  m_data->store.forget();
}
void GuideBuilder::setBounds(const Float3& lower, const Float3& upper) {
  const Float3 extent = upper - lower;
  if (!(extent.x >= 0 && extent.y >= 0 && extent.z >= 0 && std::isfinite(dot(extent, extent))))
    throw std::invalid_argument("odisSetBounds: expected finite numbers, lower <= upper");
  const CellGrid grid = gridAround(lower, extent, m_data->options.cellsPerDiagonal);
  m_data->store.move(grid.coarser(coarsening()));
}

const GuideOptions& GuideBuilder::options() const {
  return m_data->options;
}
uint64_t GuideBuilder::modelId() const {
  return m_data->modelId;
}
VertexCounts GuideBuilder::vertexCounts() const {
  return m_data->store.vertexCounts();
}
void GuideBuilder::setProgress(OdisProgressFunction function, void* user) {
  m_data->progress = Progress(function, user);
}
void GuideBuilder::limitBytes(uint64_t most, uint64_t vertices) {
  constexpr uint64_t kPerGuide = kMapTexels * sizeof(uint16_t) + kSumsPerMap * sizeof(float) +
                                 sizeof(CellDecisions) + sizeof(uint64_t) + 2 * sizeof(CellSlot);
  constexpr uint64_t kPerCell = sizeof(CellStatistics) + sizeof(Surroundings) + sizeof(LightField) +
                                sizeof(DirectionDistribution) + 2 * sizeof(CellMoments) + 2 * kPerGuide;
  const uint64_t tables = 2 * sizeof(float) * (m_data->options.lightGroups + 1);
  const uint64_t samples = vertices * (sizeof(CellSample) + sizeof(uint32_t) + sizeof(void*));
  m_data->store.limitCells((most - std::min(most, samples)) / (kPerCell + tables));
}
int GuideBuilder::coarsening() const {
  return m_data->store.coarsening();
}
uint64_t GuideBuilder::samplesLeftOut() const {
  return m_data->store.samplesLeftOut();
}
double GuideBuilder::visitedCells() const {
  return m_data->store.visitedCells();
}
uint64_t GuideBuilder::heldBytes() const {
  return m_data->store.bytes();
}
uint64_t GuideBuilder::bytes() const {
  // What build() makes beside the cells' statistics: distributions, and sums for the BSDF sampling fraction.
  constexpr uint64_t kPerCell = sizeof(DirectionDistribution) + 2 * sizeof(CellMoments);
  const CellStore& store = m_data->store;
  return store.bytes() + std::max(store.transientBytes(), store.index().size() * kPerCell);
}

// A guide of maps alone, made for coarse levels first; leaves the distributions that they were made from.
Guide GuideBuilder::Data::buildMaps(const std::vector<CellStatistics>& cells,
                                    std::vector<DirectionDistribution>& distributions) const {
  Guide guide;
  guide.m_data = std::make_shared<Guide::Data>(cells.size());
  Guide::Data& result = *guide.m_data;
  result.builder = this;
  result.numbering = store.numbering();
  result.grid = store.grid();
  result.index = store.index();
  result.keys = store.keys();
  result.setCosineProduct(options.cosineProduct);
  distributions.resize(cells.size());
  forEachFromCoarse(store.tasks(), cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    if (!cells[c].hasMap) {
      distributions[c] = distributions[parent];
      result.copyMap(parent, c);
      return;
    }
    distributions[c] =
        directions->predict(chainOf(cells, c), parent == kNoCell ? nullptr : &distributions[parent]);
    packMap(distributions[c].radiance(), options.floor, result.texels.at(c * kMapTexels),
            result.sums.at(c * kSumsPerMap));
  });
  return guide;
}

void GuideBuilder::Data::addRouletteAndLights(Guide::Data& guide,
                                              const std::vector<CellStatistics>& cells) const {
  fillRoulette(store.tasks(), guide.decisions, cells, guide.prediction.image, options.controlVariate);
  guide.cachedError = options.cachedError;
  if (guide.cachedError > 0) {
    guide.cached = cacheRadiance(store.tasks(), cells);
    guide.maxDepth = store.depthShares().maxDepth();
    guide.cachedShares.assign(store.depthShares().shares().begin(), store.depthShares().shares().end());
  }
  guide.lightGroups = options.lightGroups;
  if (guide.lightGroups > 0)
    guide.lightTables =
        tabulateLights(store.tasks(), guide.decisions, cells, *lights, guide.lightGroups, options.lightParts);
}

Guide GuideBuilder::build(VertexParts parts, ArrayView<const float> pixelValues) const {
  const uint64_t seen = countItems(parts);
  const std::vector<VertexBatch> batches = makeBatches(parts);
  std::vector<std::vector<FractionSample>> samples(batches.size());
  const VertexRules rules = m_data->rules(true);
  m_data->store.tasks().forEach(batches.size(), [&](size_t b) {
    for (const ArrayView<const PathVertex>& piece : batches[b]) {
      const std::vector<FractionSample> taken = takeFractionSamples(piece, fractionStride(seen), &rules);
      samples[b].insert(samples[b].end(), taken.begin(), taken.end());
    }
  });
  const std::vector<ArrayView<const FractionSample>> unguided(samples.begin(), samples.end());
  return m_data->build(unguided, seen, pixelValues);
}

Guide GuideBuilder::build(ArrayView<const VertexSamples> unguided, uint64_t seen,
                          ArrayView<const float> pixelValues) const {
  std::vector<ArrayView<const FractionSample>> parts;
  for (const VertexSamples& samples : unguided)
    if (samples.m_data) parts.emplace_back(samples.m_data->fractions);
  return m_data->build(parts, seen, pixelValues);
}

Guide GuideBuilder::Data::build(FractionParts unguided, uint64_t seen, ArrayView<const float> pixelValues) {
  if (options.cellsPerDiagonal == 0) return Guide();
  progress.report(0);
  const std::vector<CellStatistics>& cells = store.rollUp();
  progress.report(0.3);
  std::vector<DirectionDistribution> distributions;
  Guide guide = buildMaps(cells, distributions);
  progress.report(0.7);
  Guide::Data& result = *guide.m_data;
  result.prediction =
      chooseFractions(result.decisions, {store, cells, distributions, result.maps(), guide.view().rules,
                                         unguided, fractionStride(seen), pixelValues});
  if (const float fixed = options.fixedBsdfFraction; fixed > 0) {
    for (CellDecisions& cell : result.decisions) std::fill_n(cell.bsdfFraction, kRoughnessClasses, fixed);
    result.prediction.varianceRatio = 1;
  }
  addRouletteAndLights(result, cells);
  progress.report(1);
  return guide;
}

Guide GuideBuilder::rebuild(const Guide& previous) const {
  if (m_data->options.cellsPerDiagonal == 0) return Guide();
  if (!previous.m_data || previous.m_data->builder != m_data.get() ||
      previous.m_data->numbering != m_data->store.numbering())
    throw std::invalid_argument(
        "odisRebuildGuide: expected a guide that this builder built since odisFadeVertices, "
        "odisForgetVertices or odisSetBounds");
  const Progress& progress = m_data->progress;
  progress.report(0);
  const std::vector<CellStatistics>& cells = m_data->store.rollUp();
  progress.report(0.3);
  std::vector<DirectionDistribution> distributions;
  Guide guide = m_data->buildMaps(cells, distributions);
  progress.report(0.7);
  Guide::Data& result = *guide.m_data;

  // Old cells keep their indices, new ones follow.
  const std::vector<CellDecisions>& old = previous.m_data->decisions;
  forEachFromCoarse(m_data->store.tasks(), cells, [&](size_t c) {
    if (c < old.size())
      std::copy_n(old[c].bsdfFraction, kRoughnessClasses, result.decisions[c].bsdfFraction);
    else if (cells[c].parent != kNoCell)
      std::copy_n(result.decisions[cells[c].parent].bsdfFraction, kRoughnessClasses,
                  result.decisions[c].bsdfFraction);
  });
  result.prediction = previous.m_data->prediction;
  m_data->addRouletteAndLights(result, cells);
  progress.report(1);
  return guide;
}

}  // namespace odis::core
