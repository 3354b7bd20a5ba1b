#include "odis/models/bsdf_fraction.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "odis/cells/batches.h"
#include "odis/mixture.h"
#include "odis/pixel_sums.h"

namespace odis::core {

namespace {

// What a path's first vertex adds to its pixel.
float contributionOf(const FractionSample& v) {
  const float emission = v.emission * (v.discrete ? 1.0f : powerHeuristic(v.pdf, v.emissionLightPdf));
  const float light = v.lightPdf > 0 ? v.light * powerHeuristic(v.lightPdf, v.lightBsdfPdf) : v.light;
  return v.indirect + emission + light;
}

// What vertices' contributions are multiplied by: one over their pixel's value or, where none are given, over
// that of the pixels of an even image, whose mean is that of all chosen paths.
class PixelScale {
 public:
  explicit PixelScale(const FractionInputs& inputs) : m_values(inputs.pixelValues) {
    if (!m_values.empty()) return;
    double sum = 0, count = 0;
    for (const ArrayView<const FractionSample>& part : inputs.parts)
      for (const FractionSample& v : part) {
        if (!v.isFirst || !isForFractions(v.pixel, inputs.stride)) continue;
        const float contribution = contributionOf(v);
        if (!std::isfinite(contribution)) continue;
        sum += contribution;
        ++count;
      }
    if (sum > 0) m_inverse = float(1 / pixelValue(sum / count, sum / count));
  }
  float operator()(const FractionSample& v) const {
    return m_values.empty() ? m_inverse : 1 / m_values[v.pixel];
  }
  // Throws where a vertex has no pixel value.
  void check(const FractionSample& v) const {
    if (!m_values.empty() && v.pixel >= m_values.size())
      throw std::out_of_range("odisBuildGuide: a vertex has pixel " + std::to_string(v.pixel) +
                              ", expected less than the number of pixel values, " +
                              std::to_string(m_values.size()));
  }

 private:
  ArrayView<const float> m_values;
  float m_inverse = 1;
};

// The chosen vertices of a batch, their cells, and their part in what the whole image varies by.
struct ChosenVertices {
  std::vector<const FractionSample*> vertices;
  std::vector<uint32_t> cellOf, cells;  // as in BatchCells
  ImageMoments image;
};

// The image's variance and rays are those of the first vertices.
void addToImage(ImageMoments& image, const FractionSample& v, float scale) {
  const double value = contributionOf(v) * scale;
  const double variance = std::isfinite(value) ? std::min((value - 1) * (value - 1), 2500.0) : 0;
  ++image.count;
  image.variance += variance;
  image.rays += v.raysAfter;
}

ChosenVertices choose(const Batch<FractionSample>& batch, uint32_t stride, const PixelScale& scale,
                      const CellStore& store) {
  ChosenVertices result;
  CellIndex index;
  for (const ArrayView<const FractionSample>& piece : batch)
    for (const FractionSample& v : piece) {
      if (!isForFractions(v.pixel, stride)) continue;
      scale.check(v);
      if (v.isFirst) addToImage(result.image, v, scale(v));
      if (!v.isUsable) continue;
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
float shareOfOthers(const FractionSample& v, int texel, const CellStatistics& cell,
                    const DirectionDistribution& distribution, float limit) {
  const float value = std::min(v.value, limit);
  const Splat place = splat(reaim(v.position, v.wi, v.distance, cell.centroid));
  float own = 0;
  for (int k = 0; k < 4; ++k)
    if (place.texel[k] == texel) own += place.weight[k] * value;
  return std::max(1 - own * distribution.sensitivity / distribution.probability[texel], 0.0f);
}

// Adds a vertex, judged by its cell's map without its own sample.
SecondMoments addJudged(CellMoments& sums, const FractionSample& v, float scale, uint32_t cell, float limit,
                        const FractionInputs& inputs) {
  float mapPdf = 0, lightMapPdf = 0;
  if (v.guidableProbability > 0) {
    const SamplingMap<float> map(inputs.maps, int32_t(cell));
    if (!v.discrete) {
      const int texel = texelOf(v.wi);
      mapPdf = map.texelPdf(texel) *
               shareOfOthers(v, texel, inputs.cells[cell], inputs.distributions[cell], limit);
    }
    if (v.lightPdf > 0) lightMapPdf = map.pdf(v.lightDirection);
  }
  return addVertex(sums[size_t(roughnessClass(inputs.rules, v.roughness))], v, mapPdf, lightMapPdf, scale);
}

constexpr size_t kSmallestBatch = 4096;

// All chosen vertices in the order of their cells.
struct SortedVertices {
  explicit SortedVertices(const FractionInputs& inputs, const PixelScale& scale) {
    const std::vector<Batch<FractionSample>> all = makeBatches(inputs.parts, kSmallestBatch);
    batches.resize(all.size());
    std::vector<BatchCells> batchCells(all.size());
    inputs.store.tasks().forEach(all.size(), [&](size_t b) {
      batches[b] = choose(all[b], inputs.stride, scale, inputs.store);
      batchCells[b] = {batches[b].cellOf, batches[b].cells};
    });
    order = sortByCell<FractionSample>(
        inputs.store.tasks(), batchCells, uint32_t(inputs.cells.size()),
        [&](size_t batch, size_t i) -> const FractionSample& { return *batches[batch].vertices[i]; });
    for (const ChosenVertices& batch : batches) {
      image.count += batch.image.count;
      image.variance += batch.image.variance;
      image.rays += batch.image.rays;
    }
  }

  std::vector<ChosenVertices> batches;
  CellOrder<FractionSample> order;
  ImageMoments image;
};

// Sums of each cell, the coarser levels' included, and of the image; the second moments of each vertex.
struct AllMoments {
  std::vector<CellMoments> cells;
  CellMoments image;
  std::vector<SecondMoments> vertices;  // in the order of SortedVertices
};

AllMoments predictMoments(const SortedVertices& sorted, const FractionInputs& inputs,
                          const PixelScale& scale) {
  const std::span<const CellStatistics> cells = inputs.cells;
  AllMoments moments{
      std::vector<CellMoments>(cells.size()), {}, std::vector<SecondMoments>(sorted.order.items.size())};
  forEachCell(inputs.store.tasks(), cells.size(), [&](size_t c) {
    if (sorted.order.of(c).empty()) return;
    const CellStatistics& parent = cells[cells[c].parent];
    const float limit = inputs.store.largestValue(parent.count, parent.sum);
    SecondMoments* next = &moments.vertices[sorted.order.begin[c]];
    forEachItem(sorted.order.of(c), [&](const FractionSample& v) {
      *next++ = addJudged(moments.cells[c], v, scale(v), uint32_t(c), limit, inputs);
    });
  });
  for (int level = 0; level < kCellLevels; ++level)
    for (size_t c = 0; c < cells.size(); ++c)
      if (cells[c].level == level) {
        CellMoments& coarser = cells[c].parent == kNoCell ? moments.image : moments.cells[cells[c].parent];
        for (size_t m = 0; m < coarser.size(); ++m) coarser[m].add(moments.cells[c][m]);
      }
  return moments;
}

// Chooses by sums that are shrunk towards the parent's, those towards the parent's parent's, and so on up
// to the whole image. Returns what that saves of each vertex's second moment, in the order of SortedVertices.
std::vector<float> chooseByMoments(std::vector<CellDecisions>& result, const SortedVertices& sorted,
                                   const AllMoments& moments, const FractionInputs& inputs) {
  std::vector<CellMoments> shrunk(inputs.cells.size());
  std::vector<float> savings(sorted.order.items.size());
  forEachFromCoarse(inputs.store.tasks(), inputs.cells, [&](size_t c) {
    const uint32_t parent = inputs.cells[c].parent;
    const CellMoments& coarser = parent == kNoCell ? moments.image : shrunk[parent];
    size_t choices[kRoughnessClasses];
    for (size_t m = 0; m < kRoughnessClasses; ++m) {
      shrunk[c][m] = shrunkSums(moments.cells[c][m], coarser[m]);
      choices[m] = chooseFraction(shrunk[c][m], sorted.image);
      result[c].bsdfFraction[m] = kBsdfFractions[choices[m]];
    }
    for (uint32_t i = sorted.order.begin[c]; i < sorted.order.begin[c + 1]; ++i) {
      const FractionSample& v = *sorted.order.items[i];
      const size_t choice = choices[roughnessClass(inputs.rules, v.roughness)];
      savings[i] = moments.vertices[i][0] - moments.vertices[i][choice];
    }
  });
  return savings;
}

}  // namespace

GuidingPrediction chooseFractions(std::vector<CellDecisions>& result, const FractionInputs& inputs) {
  const PixelScale scale(inputs);
  const SortedVertices sorted(inputs, scale);
  GuidingPrediction prediction;
  prediction.image = sorted.image;
  if (!(sorted.image.count > 0)) {
    for (CellDecisions& cell : result)
      std::fill_n(cell.bsdfFraction, kRoughnessClasses, kFallbackBsdfFraction);
    return prediction;
  }
  const AllMoments moments = predictMoments(sorted, inputs, scale);
  const std::vector<float> savings = chooseByMoments(result, sorted, moments, inputs);
  const double saved = std::accumulate(savings.begin(), savings.end(), 0.0);
  if (sorted.image.variance > 0)
    prediction.varianceRatio = std::clamp(float(1 - saved / sorted.image.variance), 0.1f, 1.5f);
  return prediction;
}

}  // namespace odis::core
