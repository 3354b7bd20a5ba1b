// What a guide, samples of cells and a builder hold.
#pragma once

#include <map>
#include <optional>

#include "odis/cells/statistics.h"
#include "odis/guide.h"
#include "odis/models/bsdf_fraction.h"
#include "odis/models/direction_formula.h"
#include "odis/models/light_decision.h"
#include "odis/models/lights.h"
#include "odis/models/model.h"
#include "odis/work/progress.h"

namespace odis::core {

// Memory that begins at a cache line and is not touched before it is filled in.
template <class T>
class LineArray {
 public:
  explicit LineArray(size_t size = 0)
      : m_size(size), m_data(static_cast<T*>(::operator new[](size * sizeof(T), kLine))) {}
  T* at(size_t i) { return m_data.get() + i; }
  const T* data() const { return m_data.get(); }
  uint64_t bytes() const { return m_size * sizeof(T); }

 private:
  static constexpr std::align_val_t kLine{64};
  struct Free {
    void operator()(T* data) const { ::operator delete[](data, kLine); }
  };
  size_t m_size;
  std::unique_ptr<T, Free> m_data;
};

struct Guide::Data {
  explicit Data(size_t cells) : maps(cells * kMapShares), decisions(cells) {}

  uint16_t* mapAt(size_t cell) { return maps.at(cell * kMapShares); }

  CellGrid grid;
  CellIndex index;
  std::vector<uint64_t> keys;
  LineArray<uint16_t> maps;
  std::vector<CellDecisions> decisions;
  std::vector<CachedRadiance> cached;  // [cell][half]; empty without GuideOptions::cachedError
  float cachedError = 0;
  uint32_t maxDepth = 0;
  std::vector<float> cachedShares;  // [bounces left]; empty without maxDepth
  std::vector<float> lightTables;
  uint32_t lightGroups = 0;
  LightDecider lightDecider = LightDecider::model;
  std::vector<uint32_t> pixelCells;  // [pixel]; empty but by the paper's method
  GuidingPrediction prediction;
};

struct VertexSamples::Data {
  BatchSamples cells;
  std::vector<FractionSample> fractions;  // of unguided vertices
};

// The options of a saved builder, without a model. Throws FileError.
GuideOptions loadGuideOptions(const Archive& file);

// What one builder gathered.
struct BuilderPart {
  CellStore store;
  FractionSamples fractions;

  bool isEmpty() const {
    const VertexCounts& counts = store.vertexCounts();
    return counts.accepted + refusedVertices(counts) == 0;
  }
  uint64_t bytes() const { return store.bytes() + fractions.bytes(); }
};

struct GuideBuilder::Data {
  Data(const GuideOptions& o, Model model, std::shared_ptr<const Tasks> t)
      : options(o),
        progress(o.progressFunction, o.progressUser),
        modelId(idOf(model)),
        directions(std::move(model.directions)),
        lights(std::move(model.lights)),
        pixelNetwork(std::move(model.pixels)),
        tasks(std::move(t)) {
    if (!directions) directions = std::make_shared<DirectionFormula>(o.priorSamples);
    if (!lights) lights = std::make_shared<LightFormula>();
    if (!options.caches()) options.cachedError = 0;
    if (options.caches() && options.cachedError == 0)
      throw std::invalid_argument("cached-error: expected a positive number for a builder without a frame");
    options.model.reset();
    parts.emplace(id, BuilderPart{newStore(), {}});
  }

  CellStore newStore() const {
    CellStore store(options.clamp, directions->looksAround(), tasks);
    if (options.cachedError > 0) store.cache(options.maxDepth);
    return store;
  }
  BuilderPart& own() { return parts.at(id); }
  VertexRules rules(bool unguided) const { return {options.lightGroups, unguided}; }
  VertexSamples takeGuided(const VertexBatch& vertices);
  VertexSamples takeUnguided(const VertexBatch& vertices, uint64_t seen);

  // The cells of all parts: of the only one that is not empty, or `sum`, to which they are added in the order
  // of their ids.
  CellStore& allCells(std::optional<CellStore>& sum);
  // The grid of the parts that have one.
  const CellGrid* grid() const;
  void requireSameOptions(const Data& other) const;

  // Whether maps are only made where they are predicted to save variance.
  bool decidesMaps() const { return !options.alwaysMaps && options.fixedBsdfFraction == 0; }
  Guide build(ArrayView<const float> pixelValues);
  Guide buildMaps(const CellStore& store, const std::vector<CellStatistics>& cells,
                  const DirectionModel& model, int finestLevel,
                  std::vector<DirectionDistribution>& distributions) const;
  Guide buildCoarseMaps(const CellStore& store, const std::vector<CellStatistics>& cells,
                        std::vector<DirectionDistribution>& distributions) const;
  Guide buildFineMaps(CellStore& store, const std::vector<CellStatistics>& cells,
                      std::vector<DirectionDistribution>& distributions) const;
  void addRoulette(Guide::Data& guide, const CellStore& store,
                   const std::vector<CellStatistics>& cells) const;
  LightChoice chooseLights(const Guide::Data& guide, const std::vector<CellStatistics>& cells,
                           LightDecider decider) const;
  static void useLights(Guide::Data& guide, LightChoice choice, LightDecider decider);
  void decideLights(Guide::Data& guide, const std::vector<CellStatistics>& cells,
                    const LightDecisionInputs& inputs) const;

  GuideOptions options;
  Progress progress;
  uint64_t modelId;
  std::shared_ptr<const DirectionModel> directions;
  std::shared_ptr<const LightModel> lights;
  std::shared_ptr<const PixelModel> pixelNetwork;  // of the paper's method; null: the model has none
  std::shared_ptr<const Tasks> tasks;
  uint64_t id = 0;                        // of what this builder gathers itself
  std::map<uint64_t, BuilderPart> parts;  // by their ids
};

}  // namespace odis::core
