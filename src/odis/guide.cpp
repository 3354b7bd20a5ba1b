#include "odis/guide.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "odis/cells/statistics.h"
#include "odis/decisions/direction_model.h"
#include "odis/decisions/selection.h"

namespace odis {

struct Guide::Data {
  CellGrid grid;
  CellIndex index;
  std::vector<Cell> cells;
  float predictedVarianceRatio = 1;
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

uint64_t Guide::cellCount() const {
  return m_data ? m_data->cells.size() : 0;
}
uint64_t Guide::bytes() const {
  return m_data ? m_data->cells.size() * sizeof(Cell) + m_data->index.bytes() : 0;
}
float Guide::predictedVarianceRatio() const {
  return m_data ? m_data->predictedVarianceRatio : 1;
}

struct GuideBuilder::Data {
  explicit Data(const GuideOptions& o) : options(o), store(o.clamp) {
    if (!options.model) options.model = std::make_shared<HistogramModel>(o);
  }
  GuideOptions options;
  CellStore store;
};

GuideBuilder::GuideBuilder(const GuideOptions& options) : m_data(std::make_unique<Data>(options)) {}
GuideBuilder::~GuideBuilder() = default;

void GuideBuilder::add(std::span<const PilotVertex> vertices) {
  m_data->store.add(vertices, m_data->options.cellsPerDiagonal);
}
uint64_t GuideBuilder::bytes() const {
  return m_data->store.bytes();
}

namespace {

// Sixteen bits a texel, scaled to the brightest; at least one, so that every direction stays possible.
SamplingMap pack(const DirectionDistribution& distribution, float floor) {
  Histogram radiance;
  float sum = 0;
  for (int t = 0; t < kMapTexels; ++t)
    sum += radiance[t] = distribution.probability[t] * distribution.perCosine[t];
  float brightest = 0;
  for (float& value : radiance) {
    value = (sum > 0 ? (1 - floor) * value / sum : 0) + floor / kMapTexels;
    brightest = std::max(brightest, value);
  }
  SamplingMap map;
  for (int t = 0; t < kMapTexels; ++t)
    map.texels[t] = uint16_t(std::max(1.0f, std::round(65535 * (radiance[t] / brightest))));
  return map;
}

template <class Body>
void forEachCell(size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 16), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t cell = range.begin(); cell < range.end(); ++cell) body(cell);
  });
}

// Selection probabilities are made from about so many vertices: one pixel of `stride`, all of its path.
constexpr size_t kSelectionVertices = 400000;
bool isChosen(const PilotVertex& vertex, size_t stride) {
  return ((vertex.pixel * 0x9e3779b9u) >> 8) % stride == 0;
}

// The sums of a cell's vertices, each judged by the map without its own sample.
void sumCell(CellSelection& sums, std::span<const PilotVertex> vertices, std::span<const uint32_t> order,
             const CellStatistics& cell, const DirectionDistribution& distribution, const SamplingMap& map,
             float limit) {
  VertexMap vertexMap;
  for (const uint32_t i : order) {
    const PilotVertex& v = vertices[i];
    vertexMap.prepare(map, v.normal, v.both ? Sides::both : Sides::reflection);
    float mapPdf = 0;
    if (!v.discrete) {
      const int texel = texelOf(v.wi);
      const float value = std::min(sampleValue(v), limit);
      const Splat place = splat(reaim(v, cell.centroid));
      float own = 0;
      for (int k = 0; k < 4; ++k)
        if (place.texel[k] == texel) own += place.weight[k] * value;
      const float kept = 1 - own * distribution.sensitivity / distribution.probability[texel];
      mapPdf = vertexMap.texelPdf(texel) * std::max(kept, 0.0f);
    }
    addVertex(sums, v, mapPdf, v.lightPdf > 0 ? vertexMap.pdf(v.lightDirection) : 0);
  }
}

}  // namespace

Guide GuideBuilder::build(std::span<const PilotVertex> vertices) const {
  const GuideOptions& options = m_data->options;
  const std::vector<CellStatistics> cells = m_data->store.rollUp();
  Guide guide;
  guide.m_data = std::make_unique<Guide::Data>();
  guide.m_data->grid = m_data->store.grid();
  guide.m_data->index = m_data->store.index();
  guide.m_data->cells.resize(cells.size());
  std::vector<Cell>& result = guide.m_data->cells;

  // Maps, coarse levels first.
  std::vector<DirectionDistribution> distributions(cells.size());
  for (int level = kCellLevels - 1; level >= 0; --level)
    forEachCell(cells.size(), [&](size_t c) {
      if (cells[c].level != level) return;
      distributions[c] = options.model->predict(
          cells[c], cells[c].parent == kNoCell ? nullptr : &distributions[cells[c].parent]);
      result[c].map = pack(distributions[c], options.floor);
    });
  if (options.fixedAlpha > 0) {
    for (Cell& cell : result) std::fill(cell.alpha, cell.alpha + kMaterialClasses, options.fixedAlpha);
    return guide;
  }

  // Predicted second moments and rays of each cell, then of the coarser levels. A part of the vertices is
  // enough.
  const size_t stride = std::max<size_t>(1, vertices.size() / kSelectionVertices);
  std::vector<uint32_t> cellOfVertex(vertices.size(), kNoCell);
  tbb::parallel_for(size_t(0), vertices.size(), [&](size_t i) {
    if (isChosen(vertices[i], stride) && (vertices[i].discrete || isUsable(vertices[i])))
      cellOfVertex[i] =
          guide.m_data->index.find(guide.m_data->grid.key(vertices[i].position, vertices[i].normal, 0));
  });
  const CellOrder sorted = sortByCell(cellOfVertex, uint32_t(cells.size()));
  std::vector<CellSelection> sums(cells.size());
  forEachCell(cells.size(), [&](size_t c) {
    const CellStatistics& cell = cells[c];
    if (cell.level != 0) return;
    const CellStatistics& parent = cells[cell.parent];
    const float limit = parent.count > 0 ? m_data->store.clamp() * float(parent.sum / parent.count) : 0;
    sumCell(sums[c], vertices,
            std::span(sorted.order).subspan(sorted.begin[c], sorted.begin[c + 1] - sorted.begin[c]), cell,
            distributions[c], result[c].map, limit);
  });
  for (int level = 0; level + 1 < kCellLevels; ++level)
    for (size_t c = 0; c < cells.size(); ++c)
      if (cells[c].level == level)
        for (int m = 0; m < kMaterialClasses; ++m) sums[cells[c].parent][m].add(sums[c][m]);
  CellSelection image;
  for (size_t c = 0; c < cells.size(); ++c)
    if (cells[c].level == 0)
      for (int m = 0; m < kMaterialClasses; ++m) image[m].add(sums[c][m]);

  // The image's variance and rays are those of the first vertices.
  SelectionTotals totals;
  for (const PilotVertex& v : vertices)
    if (v.depth == 1 && isChosen(v, stride)) {
      const float emission = v.emission * (v.discrete ? 1.0f : powerHeuristic(v.pdf, v.emissionLightPdf));
      const float light = v.lightPdf > 0 ? v.light * powerHeuristic(v.lightPdf, v.lightBsdfPdf) : v.light;
      const double value = v.indirect + emission + light;
      if (std::isfinite(value)) totals.variance += std::min((value - 1) * (value - 1), 2500.0);
      totals.rays += v.raysAfter;
    }

  // A cell's sums are backed by its parent's, those by the parent's parent's, and so on up to the whole
  // image.
  std::vector<CellSelection> backed(cells.size());
  for (int level = kCellLevels - 1; level >= 0; --level)
    for (size_t c = 0; c < cells.size(); ++c)
      if (cells[c].level == level)
        for (int m = 0; m < kMaterialClasses; ++m)
          backed[c][m] = back(sums[c][m], cells[c].parent == kNoCell ? image[m] : backed[cells[c].parent][m]);

  // Choices, and the variance that they predict.
  double saved = 0;
  for (size_t c = 0; c < cells.size(); ++c)
    for (int m = 0; m < kMaterialClasses; ++m) {
      const size_t choice = chooseAlpha(backed[c][m], totals);
      result[c].alpha[m] = kAlphas[choice];
      if (cells[c].level == 0) saved += sums[c][m].secondMoment[0] - sums[c][m].secondMoment[choice];
    }
  if (totals.variance > 0)
    guide.m_data->predictedVarianceRatio = std::clamp(float(1 - saved / totals.variance), 0.1f, 1.5f);
  return guide;
}

}  // namespace odis
