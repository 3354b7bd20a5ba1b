#include "odis/decisions/choose_alphas.h"

#include <tbb/parallel_for.h>

#include "odis/decisions/selection.h"

namespace odis {

namespace {

// Selection probabilities are made from a quarter of the vertices, within these bounds: one pixel of `stride`, all of its
// path. A pilot that is a small part of the image is worth as little time.
constexpr size_t kShare = 4, kFewestVertices = 50000, kMostVertices = 200000;
bool isChosen(const PilotVertex& vertex, uint32_t stride) {
  return ((vertex.pixel * 0x9e3779b9u) >> 8) % stride == 0;
}

// What vertices' contributions are multiplied by.
class PixelScale {
 public:
  explicit PixelScale(std::span<const float> values) : m_values(values) {}
  float operator()(const PilotVertex& v) const { return m_values.empty() ? 1 : 1 / m_values[v.pixel]; }

 private:
  std::span<const float> m_values;
};

// The chosen vertices of a batch, their cells, and their part in what the whole image varies by.
struct BatchSelection {
  std::vector<const PilotVertex*> vertices;
  std::vector<uint32_t> cellOf, cells;  // as in BatchCells
  SelectionTotals totals;
  std::vector<std::pair<uint32_t, float>> variances;  // pixels and theirs
};

// The image's variance and rays are those of the first vertices.
void addToTotals(BatchSelection& batch, const PilotVertex& v, float scale) {
  const float emission = v.emission * (v.discrete ? 1.0f : powerHeuristic(v.pdf, v.emissionLightPdf));
  const float light = v.lightPdf > 0 ? v.light * powerHeuristic(v.lightPdf, v.lightBsdfPdf) : v.light;
  const double value = (v.indirect + emission + light) * scale;
  const double variance = std::isfinite(value) ? std::min((value - 1) * (value - 1), 2500.0) : 0;
  ++batch.totals.count;
  batch.totals.variance += variance;
  batch.totals.rays += v.raysAfter;
  batch.variances.emplace_back(v.pixel, float(variance));
}

BatchSelection select(const PilotBatch& batch, uint32_t stride, const PixelScale& scale,
                      const CellStore& store) {
  BatchSelection result;
  CellIndex index;
  for (const std::span<const PilotVertex> piece : batch)
    for (const PilotVertex& v : piece) {
      if (!isChosen(v, stride)) continue;
      if (v.depth == 1) addToTotals(result, v, scale(v));
      if (!v.discrete && !isUsable(v)) continue;
      const uint64_t key = store.grid().key(v.position, v.normal, 0);
      const uint32_t cell = index.insert(key);
      if (cell == result.cells.size()) result.cells.push_back(store.index().find(key));
      if (result.cells[cell] == kNoCell) continue;
      result.vertices.push_back(&v);
      result.cellOf.push_back(cell);
    }
  return result;
}

// The share of its texel's density that a vertex's own sample did not make.
float shareOfOthers(const PilotVertex& v, int texel, const CellStatistics& cell,
                    const DirectionDistribution& distribution, float limit) {
  const float value = std::min(sampleValue(v), limit);
  const Splat place = splat(reaim(v.position, v.wi, v.distance, cell.centroid));
  float own = 0;
  for (int k = 0; k < 4; ++k)
    if (place.texel[k] == texel) own += place.weight[k] * value;
  return std::max(1 - own * distribution.sensitivity / distribution.probability[texel], 0.0f);
}

// Adds a vertex, judged by its cell's map without its own sample.
SecondMoments addJudged(CellSelection& sums, const PilotVertex& v, float scale, const SamplingMap& map,
                        const CellStatistics& cell, const DirectionDistribution& distribution, float limit) {
  float mapPdf = 0, lightMapPdf = 0;
  if (v.guidableProbability > 0) {
    VertexMap vertexMap;
    vertexMap.prepare(map, v.normal, v.both ? Sides::both : Sides::reflection);
    if (!v.discrete) {
      const int texel = texelOf(v.wi);
      mapPdf = vertexMap.texelPdf(texel) * shareOfOthers(v, texel, cell, distribution, limit);
    }
    if (v.lightPdf > 0) lightMapPdf = vertexMap.pdf(v.lightDirection);
  }
  return addVertex(sums, v, mapPdf, lightMapPdf, scale);
}

}  // namespace

AlphaPrediction chooseAlphas(std::vector<Cell>& result, const CellStore& store,
                             std::span<const CellStatistics> cells,
                             std::span<const DirectionDistribution> distributions, PilotParts parts,
                             std::span<const float> pixelValues) {
  // Choose vertices and sort them by cell.
  const size_t count = countVertices(parts);
  const uint32_t stride =
      uint32_t(std::max<size_t>(1, count / std::clamp(count / kShare, kFewestVertices, kMostVertices)));
  const PixelScale scale(pixelValues);
  const std::vector<PilotBatch> pilot = makeBatches(parts);
  std::vector<BatchSelection> batches(pilot.size());
  std::vector<BatchCells> batchCells(pilot.size());
  tbb::parallel_for(size_t(0), pilot.size(), [&](size_t b) {
    batches[b] = select(pilot[b], stride, scale, store);
    batchCells[b] = {batches[b].cellOf, batches[b].cells};
  });
  const CellOrder<PilotVertex> order = sortByCell<PilotVertex>(
      batchCells, uint32_t(cells.size()),
      [&](size_t batch, size_t i) -> const PilotVertex& { return *batches[batch].vertices[i]; });
  SelectionTotals totals;
  for (const BatchSelection& batch : batches) {
    totals.count += batch.totals.count;
    totals.variance += batch.totals.variance;
    totals.rays += batch.totals.rays;
  }

  // Predicted second moments and rays of each cell, then of the coarser levels and of the image.
  std::vector<CellSelection> sums(cells.size());
  std::vector<SecondMoments> moments(order.items.size());
  forEachCell(cells.size(), [&](size_t c) {
    if (order.of(c).empty()) return;
    const CellStatistics& parent = cells[cells[c].parent];
    const float limit = parent.count > 0 ? store.clamp() * float(parent.sum / parent.count) : 0;
    SecondMoments* next = &moments[order.begin[c]];
    forEachItem(order.of(c), [&](const PilotVertex& v) {
      *next++ = addJudged(sums[c], v, scale(v), result[c].map, cells[c], distributions[c], limit);
    });
  });
  CellSelection image;
  for (int level = 0; level < kCellLevels; ++level)
    for (size_t c = 0; c < cells.size(); ++c)
      if (cells[c].level == level) {
        CellSelection& coarser = cells[c].parent == kNoCell ? image : sums[cells[c].parent];
        for (int m = 0; m < kMaterialClasses; ++m) coarser[m].add(sums[c][m]);
      }

  // A cell's sums are backed by its parent's, those by the parent's parent's, and so on up to the whole
  // image. They choose; the cell's own vertices tell what that saves each pixel.
  AlphaPrediction prediction;
  prediction.totals = totals;
  prediction.pixels.resize(pixelValues.size());
  std::vector<CellSelection> backed(cells.size());
  std::vector<std::pair<uint32_t, float>> savings(order.items.size());  // pixels, and what they save
  forEachFromCoarse(cells, [&](size_t c) {
    const CellSelection& coarser = cells[c].parent == kNoCell ? image : backed[cells[c].parent];
    size_t choices[kMaterialClasses];
    for (int m = 0; m < kMaterialClasses; ++m) {
      backed[c][m] = back(sums[c][m], coarser[m]);
      choices[m] = chooseAlpha(backed[c][m], totals);
      result[c].alpha[m] = kAlphas[choices[m]];
    }
    for (uint32_t i = order.begin[c]; i < order.begin[c + 1]; ++i) {
      const PilotVertex& v = *order.items[i];
      savings[i] = {v.pixel, moments[i][0] - moments[i][choices[int(materialClass(v.roughness))]]};
    }
  });
  double saved = 0;
  for (const auto& [pixel, saving] : savings) {
    saved += saving;
    if (!pixelValues.empty()) prediction.pixels[pixel].saved += saving;
  }
  if (!pixelValues.empty())
    for (const BatchSelection& batch : batches)
      for (const auto& [pixel, variance] : batch.variances) prediction.pixels[pixel].variance += variance;
  if (totals.variance > 0)
    prediction.varianceRatio = std::clamp(float(1 - saved / totals.variance), 0.1f, 1.5f);
  return prediction;
}

}  // namespace odis
