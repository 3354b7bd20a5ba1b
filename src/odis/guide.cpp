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
#include "odis/options/settings.h"
#include "odis/paper_method.h"
#include "odis/record/vertex_order.h"
#include "odis/work/progress.h"

namespace odis::core {

namespace {

// The options, if all are in their ranges.
const GuideOptions& checked(const GuideOptions& options) {
  if (options.lightGroups > kMaxLightGroups)
    throw std::invalid_argument("OdisGuideOptions.lightGroups: expected at most " +
                                std::to_string(kMaxLightGroups) + ", found " +
                                std::to_string(options.lightGroups));
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

// Whether maps would not pay for themselves, as coarse ones tell
// (docs/experiments/0071-maps-and-lights-that-pay.md).
bool savesLittle(const GuidingPrediction& prediction) {
  constexpr float kLeastSaved = 0.04f;
  return prediction.image.count > 0 && prediction.varianceRatio > 1 - kLeastSaved;
}
void setFractions(std::vector<CellDecisions>& decisions, float fraction) {
  for (CellDecisions& cell : decisions) std::fill_n(cell.bsdfFraction, kRoughnessClasses, fraction);
}
bool leavesAllToBsdf(const std::vector<CellDecisions>& decisions) {
  return std::all_of(decisions.begin(), decisions.end(), [](const CellDecisions& cell) {
    return std::all_of(cell.bsdfFraction, cell.bsdfFraction + kRoughnessClasses,
                       [](float fraction) { return fraction == 1; });
  });
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
  view.maps = m_data->maps.data();
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
  return m_data->index.bytes() + m_data->keys.size() * sizeof(uint64_t) + m_data->maps.bytes() +
         m_data->decisions.size() * sizeof(CellDecisions) + m_data->lightTables.size() * sizeof(float) +
         m_data->pixelCells.size() * sizeof(uint32_t);
}
float Guide::predictedVarianceRatio() const {
  return m_data ? m_data->prediction.varianceRatio : 1;
}

bool Guide::guidesDirections() const {
  return m_data && !leavesAllToBsdf(m_data->decisions);
}

bool Guide::choosesLights() const {
  return m_data && m_data->lightGroups > 1 &&
         std::any_of(m_data->decisions.begin(), m_data->decisions.end(),
                     [](const CellDecisions& cell) { return cell.learnedLightFraction > 0; });
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
  if (m_data) core::narrow(m_data->fractions, fractionStride(seen));
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

VertexSamples GuideBuilder::Data::takeGuided(const VertexBatch& vertices) {
  if (options.cellsPerDiagonal == 0) return {};
  VertexSamples result;
  result.m_data = std::make_unique<VertexSamples::Data>(
      VertexSamples::Data{own().store.take(vertices, rules(false)), {}});
  return result;
}
VertexSamples GuideBuilder::Data::takeUnguided(const VertexBatch& vertices, uint64_t seen) {
  if (options.cellsPerDiagonal == 0) return {};
  VertexSamples result;
  const VertexRules unguided = rules(true);
  BatchSamples cells = own().store.takeWithoutCells(vertices, unguided);
  const bool areUsable = refusedVertices(cells.counts) == cells.counts.discrete;
  result.m_data = std::make_unique<VertexSamples::Data>(VertexSamples::Data{
      std::move(cells),
      takeFractionSamples(vertices, fractionStride(seen), areUsable ? nullptr : &unguided)});
  return result;
}
VertexSamples GuideBuilder::takeGuided(ArrayView<const PathVertex> vertices) const {
  return m_data->takeGuided({vertices});
}
VertexSamples GuideBuilder::takeUnguided(ArrayView<const PathVertex> vertices, uint64_t seen) const {
  return m_data->takeUnguided({vertices}, seen);
}

void GuideBuilder::addToCells(ArrayView<VertexSamples> samples) {
  if (m_data->options.cellsPerDiagonal == 0) return;
  std::vector<BatchSamples*> batches;
  for (VertexSamples& taken : samples)
    if (taken.m_data) batches.push_back(&taken.m_data->cells);
  m_data->own().store.add(batches, m_data->options.cellsPerDiagonal);
  for (BatchSamples* batch : batches) batch->release();
}
void GuideBuilder::addToFractions(ArrayView<VertexSamples> samples) {
  FractionSamples& kept = m_data->own().fractions;
  size_t more = 0;
  uint64_t vertices = 0;
  for (const VertexSamples& taken : samples) {
    if (taken.m_data) more += taken.m_data->fractions.size();
    const VertexCounts counts = taken.counts();
    vertices += counts.accepted + refusedVertices(counts);
  }
  kept.makeRoom(more);
  for (VertexSamples& taken : samples) {
    if (!taken.m_data) continue;
    const std::vector<FractionSample> unguided = std::exchange(taken.m_data->fractions, {});
    kept.samples.insert(kept.samples.end(), unguided.begin(), unguided.end());
  }
  kept.see(vertices);
}

void GuideBuilder::add(VertexParts parts) {
  const std::vector<ArrayView<const PathVertex>> ordered = inOrder(parts);
  const std::vector<VertexBatch> batches = makeBatches<PathVertex>(ordered);
  const uint64_t seen = m_data->own().fractions.seen + countItems(parts);
  std::vector<VertexSamples> samples(batches.size());
  m_data->tasks->forEach(batches.size(),
                         [&](size_t b) { samples[b] = m_data->takeUnguided(batches[b], seen); });
  addToCells(samples);
  addToFractions(samples);
}
void GuideBuilder::addGuided(VertexParts parts) {
  const std::vector<ArrayView<const PathVertex>> ordered = inOrder(parts);
  const std::vector<VertexBatch> batches = makeBatches<PathVertex>(ordered);
  std::vector<VertexSamples> samples(batches.size());
  m_data->tasks->forEach(batches.size(), [&](size_t b) { samples[b] = m_data->takeGuided(batches[b]); });
  addToCells(samples);
}

void GuideBuilder::fade(float weight) {
  if (!(weight >= 0 && weight <= 1))
    throw std::invalid_argument("odisFadeVertices: weight: expected a number from 0 to 1");
  for (auto& [id, part] : m_data->parts) part.store.fade(weight);
  if (weight < 1) forgetFractions();
}
void GuideBuilder::forget() {
  BuilderPart own = std::move(m_data->own());
  own.store.forget();
  own.fractions = {};
  m_data->parts.clear();
  m_data->parts.emplace(m_data->id, std::move(own));
}
void GuideBuilder::forgetFractions() {
  for (auto& [id, part] : m_data->parts) part.fractions = {};
}
void GuideBuilder::setBounds(const Float3& lower, const Float3& upper) {
  const Float3 extent = upper - lower;
  if (!(extent.x >= 0 && extent.y >= 0 && extent.z >= 0 && std::isfinite(dot(extent, extent))))
    throw std::invalid_argument("odisSetBounds: expected finite numbers, lower <= upper");
  const CellGrid grid = gridAround(lower, extent, m_data->options.cellsPerDiagonal).coarser(coarsening());
  for (auto& [id, part] : m_data->parts) part.store.move(grid);
}

const GuideOptions& GuideBuilder::options() const {
  return m_data->options;
}
uint64_t GuideBuilder::modelId() const {
  return m_data->modelId;
}
VertexCounts GuideBuilder::vertexCounts() const {
  VertexCounts counts;
  for (const auto& [id, part] : m_data->parts) addCounts(counts, part.store.vertexCounts());
  return counts;
}
void GuideBuilder::setProgress(OdisProgressFunction function, void* user) {
  m_data->progress = Progress(function, user);
}
void GuideBuilder::limitBytes(uint64_t most, uint64_t vertices) {
  constexpr uint64_t kPerGuide =
      kMapShares * sizeof(uint16_t) + sizeof(CellDecisions) + sizeof(uint64_t) + 2 * sizeof(CellSlot);
  constexpr uint64_t kPerCell = sizeof(CellStatistics) + sizeof(Surroundings) + sizeof(LightField) +
                                sizeof(DirectionDistribution) + 2 * sizeof(CellMoments) + 2 * kPerGuide;
  const uint64_t tables = 2 * sizeof(float) * (m_data->options.lightGroups + 1);
  const uint64_t samples = vertices * (sizeof(CellSample) + sizeof(uint32_t) + sizeof(void*));
  uint64_t others = m_data->own().fractions.bytes();
  for (const auto& [id, part] : m_data->parts)
    if (id != m_data->id) others += part.bytes() + part.store.index().size() * (kPerCell + tables);
  m_data->own().store.limitCells((most - std::min(most, samples + others)) / (kPerCell + tables));
}
int GuideBuilder::coarsening() const {
  int most = 1;
  for (const auto& [id, part] : m_data->parts) most = std::max(most, part.store.coarsening());
  return most;
}
uint64_t GuideBuilder::samplesLeftOut() const {
  uint64_t count = 0;
  for (const auto& [id, part] : m_data->parts) count += part.store.samplesLeftOut();
  return count;
}
double GuideBuilder::visitedCells() const {
  return m_data->own().store.visitedCells();
}
uint64_t GuideBuilder::heldBytes() const {
  uint64_t bytes = 0;
  for (const auto& [id, part] : m_data->parts) bytes += part.bytes();
  return bytes;
}
uint64_t GuideBuilder::bytes() const {
  // What build() makes beside the cells' statistics: distributions, and sums for the BSDF sampling fraction.
  constexpr uint64_t kPerCell = sizeof(DirectionDistribution) + 2 * sizeof(CellMoments);
  uint64_t cells = 0, ofParts = 0;
  for (const auto& [id, part] : m_data->parts) {
    cells += part.store.index().size();
    ofParts += part.store.bytes();
  }
  const uint64_t ofSum = partCount() > 1 ? ofParts : 0;
  return heldBytes() + ofSum + std::max(m_data->own().store.transientBytes(), cells * kPerCell);
}

// What the radiance in a cell's map is multiplied by: the mean cosine to the normals of its vertices or, in
// media and without the product, nothing.
static Histogram cosinesIn(const CellStatistics& cell, bool cosineProduct) {
  if (!cosineProduct || !(cell.count > 0) || cell.inMedium) {
    Histogram ones;
    ones.fill(1);
    return ones;
  }
  const auto perVertex = float(1 / cell.count);
  return meanCosines(cell.normal * perVertex, float(cell.bothSides) * perVertex);
}

// A guide of maps alone, made by a model for coarse levels first; finer ones than `finestLevel` take their
// parents'. Leaves the distributions that they were made from.
Guide GuideBuilder::Data::buildMaps(const CellStore& store, const std::vector<CellStatistics>& cells,
                                    const DirectionModel& model, int finestLevel,
                                    std::vector<DirectionDistribution>& distributions) const {
  Guide guide;
  guide.m_data = std::make_shared<Guide::Data>(cells.size());
  Guide::Data& result = *guide.m_data;
  result.grid = store.grid();
  result.index = store.index();
  result.keys = store.keys();
  distributions.resize(cells.size());
  const DirectionFormula formula(options.priorSamples);
  forEachFromCoarse(*tasks, cells, [&](size_t c) {
    const uint32_t parent = cells[c].parent;
    if (parent != kNoCell && (!cells[c].hasMap || cells[c].level < finestLevel)) {
      distributions[c] = distributions[parent];
      std::copy_n(result.mapAt(parent), kMapShares, result.mapAt(c));
      return;
    }
    distributions[c] = modelFor<DirectionModel>(cells[c], model, formula)
                           .predict(chainOf(cells, c), parent == kNoCell ? nullptr : &distributions[parent]);
    packMap(product(distributions[c].radiance(), options.floor, cosinesIn(cells[c], options.cosineProduct)),
            result.mapAt(c));
  });
  return guide;
}

// Maps of the two coarsest levels by the formula, which cost next to nothing.
Guide GuideBuilder::Data::buildCoarseMaps(const CellStore& store, const std::vector<CellStatistics>& cells,
                                          std::vector<DirectionDistribution>& distributions) const {
  return buildMaps(store, cells, DirectionFormula(options.priorSamples), kCellLevels - 2, distributions);
}

Guide GuideBuilder::Data::buildFineMaps(CellStore& store, const std::vector<CellStatistics>& cells,
                                        std::vector<DirectionDistribution>& distributions) const {
  store.lookAround();
  return buildMaps(store, cells, *directions, 0, distributions);
}

void GuideBuilder::Data::addRoulette(Guide::Data& guide, const CellStore& store,
                                     const std::vector<CellStatistics>& cells) const {
  fillRoulette(*tasks, guide.decisions, cells, guide.prediction.image, options.controlVariate);
  guide.cachedError = options.cachedError;
  if (guide.cachedError > 0) {
    guide.cached = cacheRadiance(*tasks, cells);
    guide.maxDepth = store.depthShares().maxDepth();
    guide.cachedShares.assign(store.depthShares().shares().begin(), store.depthShares().shares().end());
  }
}

// The guide's decisions with the learned-light fractions by the model or the formula, and the tables.
LightChoice GuideBuilder::Data::chooseLights(const Guide::Data& guide,
                                             const std::vector<CellStatistics>& cells,
                                             LightDecider decider) const {
  LightChoice choice;
  choice.decisions = guide.decisions;
  const LightFormula formula;
  const LightModel& model = decider == LightDecider::model ? *lights : formula;
  choice.tables =
      tabulateLights(*tasks, choice.decisions, cells, model, options.lightGroups, options.lightParts);
  return choice;
}

// Gives a guide its choice of lights. Where nothing decides the tables are the formula's, and not followed.
void GuideBuilder::Data::useLights(Guide::Data& guide, LightChoice choice, LightDecider decider) {
  guide.lightDecider = decider;
  guide.lightTables = std::move(choice.tables);
  guide.decisions = std::move(choice.decisions);
  if (decider == LightDecider::nothing)
    for (CellDecisions& cell : guide.decisions) cell.learnedLightFraction = 0;
}

// Chooses lights in the way that the pilot's vertices predict to be best.
void GuideBuilder::Data::decideLights(Guide::Data& guide, const std::vector<CellStatistics>& cells,
                                      const LightDecisionInputs& inputs) const {
  LightChoice model = chooseLights(guide, cells, LightDecider::model);
  LightChoice formula = chooseLights(guide, cells, LightDecider::formula);
  const LightDecider decider = core::decideLights(inputs, formula, model);
  useLights(guide, std::move(decider == LightDecider::model ? model : formula), decider);
}

Guide GuideBuilder::build(ArrayView<const float> pixelValues) const {
  return m_data->build(pixelValues);
}

Guide GuideBuilder::Data::build(ArrayView<const float> pixelValues) {
  if (options.cellsPerDiagonal == 0) return Guide();
  progress.report(0);
  std::optional<CellStore> sum;
  CellStore& store = allCells(sum);
  const std::vector<CellStatistics>& cells = store.rollUp();
  progress.report(0.3);
  std::vector<ArrayView<const FractionSample>> unguided;
  uint64_t seen = 0;
  for (const auto& [id, part] : parts) {
    unguided.emplace_back(part.fractions.samples);
    seen += part.fractions.seen;
  }
  std::vector<DirectionDistribution> distributions;
  const auto predict = [&](Guide& guide) {
    Guide::Data& data = *guide.m_data;
    data.prediction =
        chooseFractions(data.decisions, {store, cells, distributions, data.maps.data(), guide.view().rules,
                                         unguided, fractionStride(seen), pixelValues});
  };
  Guide guide;
  if (decidesMaps()) {
    guide = buildCoarseMaps(store, cells, distributions);
    predict(guide);
  }
  if (!guide.m_data || !savesLittle(guide.m_data->prediction)) {
    guide = buildFineMaps(store, cells, distributions);
    progress.report(0.7);
    predict(guide);
  } else {
    setFractions(guide.m_data->decisions, 1);
  }
  Guide::Data& result = *guide.m_data;
  if (options.fixedBsdfFraction > 0) {
    setFractions(result.decisions, options.fixedBsdfFraction);
    result.prediction.varianceRatio = 1;
  }
  addRoulette(result, store, cells);
  result.lightGroups = options.lightGroups;
  if (result.lightGroups > 0)
    decideLights(result, cells, {store, unguided, fractionStride(seen), pixelValues, result.lightGroups});
  progress.report(1);
  return guide;
}

bool GuideBuilder::canRebuild(const Guide& previous) const {
  if (m_data->options.cellsPerDiagonal == 0) return true;
  if (!previous.m_data) return false;
  const CellGrid* grid = m_data->grid();
  return previous.m_data->index.size() == 0 || (grid && previous.m_data->grid == *grid);
}

Guide GuideBuilder::rebuild(const Guide& previous) const {
  if (m_data->options.cellsPerDiagonal == 0) return Guide();
  if (!canRebuild(previous))
    throw std::invalid_argument(
        "odisRebuildGuide: expected a guide of cells as the builder has them since odisForgetVertices or "
        "odisSetBounds");
  std::optional<CellStore> sum;
  CellStore& store = m_data->allCells(sum);
  const Progress& progress = m_data->progress;
  progress.report(0);
  const std::vector<CellStatistics>& cells = store.rollUp();
  progress.report(0.3);
  const Guide::Data& old = *previous.m_data;
  std::vector<DirectionDistribution> distributions;
  Guide guide = m_data->decidesMaps() && !previous.guidesDirections()
                    ? m_data->buildCoarseMaps(store, cells, distributions)
                    : m_data->buildFineMaps(store, cells, distributions);
  progress.report(0.7);
  Guide::Data& result = *guide.m_data;
  forEachFromCoarse(*m_data->tasks, cells, [&](size_t c) {
    const uint32_t known = old.index.find(result.keys[c]);
    if (known == kNoCell && cells[c].parent == kNoCell) return;
    const CellDecisions& from = known != kNoCell ? old.decisions[known] : result.decisions[cells[c].parent];
    std::copy_n(from.bsdfFraction, kRoughnessClasses, result.decisions[c].bsdfFraction);
  });
  result.prediction = old.prediction;
  m_data->addRoulette(result, store, cells);
  result.lightGroups = m_data->options.lightGroups;
  if (result.lightGroups > 0)
    Data::useLights(result, m_data->chooseLights(result, cells, old.lightDecider), old.lightDecider);
  progress.report(1);
  return guide;
}

}  // namespace odis::core
