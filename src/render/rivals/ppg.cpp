#include "render/rivals/ppg.h"

#include <tbb/parallel_for.h>

#include "render/path/path.h"
#include "render/sampler/sampler.h"

namespace odis::render {

namespace {

// The BSDF sampling fraction is learnt with the constants of Müller's code; bounded so that no direction
// that the tree deems dark costs more than a hundredfold weight.
constexpr float kLearningRate = 0.01f, kRegularization = 0.01f, kMaxLogit = 4.59512f;  // 1 % to 99 %

}  // namespace

const DirectionSampler* PracticalPathGuiding::at(const Vec3& position, const Vec3&, bool) const {
  if (m_iteration == 0) return nullptr;
  const SdLeaf& leaf = m_tree.leaves()[m_tree.find(position)];
  // Where no light was seen to arrive there is nothing to go by.
  return leaf.known.total() > 0 ? &leaf : nullptr;
}

// Trees hold radiance alone, on surfaces and in media alike.
const DirectionSampler* PracticalPathGuiding::inMedium(const Vec3& position, const Vec3&, float) const {
  return at(position, {}, true);
}

Rival::Combination PracticalPathGuiding::combination() const {
  return m_options.combine == PpgOptions::Combine::last ? Combination::last : Combination::inverseVariance;
}

uint32_t PracticalPathGuiding::iterationEnd(uint32_t done, uint32_t spp) const {
  // Iterations so far: 1 + 2 + 4 + ... = done, so the next one has done + 1.
  const uint32_t turn = done + 1, left = spp - done;
  return left < 3 * turn ? spp : done + turn;
}

// The tree spans what the first pass saw.
void PracticalPathGuiding::place(std::span<const std::vector<PathVertex>> tiles) {
  Vec3 low(kInfinity, kInfinity, kInfinity), high = -low;
  for (const std::vector<PathVertex>& tile : tiles)
    for (const PathVertex& v : tile) {
      if (!isUsable(v)) continue;
      const Vec3 p = fromOdis(v.position);
      for (int a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    }
  if (!(low.x <= high.x)) return;
  m_tree = SdTree(low, high);
  m_tree.leaves()[0].learning = Quadtree().refined(m_options.flux);
  m_placed = true;
}

// The leaves that a vertex is recorded in: the one it lies in, the one that a random point of a box of that
// leaf's size around it lies in, or all that this box meets.
void PracticalPathGuiding::assign(const PathVertex& vertex, uint64_t random,
                                  std::vector<Entry>& entries) const {
  const Vec3 position = fromOdis(vertex.position);
  if (m_options.spatial == PpgOptions::Spatial::nearest) {
    entries.push_back({&vertex, m_tree.find(position), 1});
    return;
  }
  const SdTree::Place place = m_tree.place(position);
  const Vec3 half = (place.high - place.low) * 0.5f;
  if (m_options.spatial == PpgOptions::Spatial::box) {
    const Vec3 middle = m_tree.clipped(position);
    m_tree.overlapping(middle - half, middle + half, [&](uint32_t leaf, float weight) {
      entries.push_back({&vertex, leaf, weight});
    });
    return;
  }
  Vec3 offset = half;
  for (int a = 0; a < 3; ++a) {
    random = mixBits(random + 0x9e3779b97f4a7c15ull);
    offset[a] *= float(random >> 40) * 0x1p-23f - 1;
  }
  entries.push_back({&vertex, m_tree.find(m_tree.clipped(position + offset)), 1});
}

void PracticalPathGuiding::learn(std::span<const std::vector<PathVertex>> tiles, uint32_t sample) {
  if (!m_placed) place(tiles);
  if (!m_placed) return;
  std::vector<std::vector<Entry>> entriesOf(tiles.size());
  tbb::parallel_for(size_t(0), tiles.size(), [&](size_t t) {
    entriesOf[t].reserve(tiles[t].size());
    for (size_t i = 0; i < tiles[t].size(); ++i)
      if (isUsable(tiles[t][i])) assign(tiles[t][i], mixBits(uint64_t(sample) << 32 | t) ^ i, entriesOf[t]);
  });

  // Sort by leaf, in the order of the vertices.
  std::vector<SdLeaf>& leaves = m_tree.leaves();
  std::vector<size_t> begin(leaves.size() + 1, 0);
  for (const std::vector<Entry>& entries : entriesOf)
    for (const Entry& e : entries) ++begin[e.leaf + 1];
  for (size_t l = 0; l < leaves.size(); ++l) begin[l + 1] += begin[l];
  std::vector<const Entry*> sorted(begin.back());
  std::vector<size_t> next(begin.begin(), begin.end() - 1);
  for (const std::vector<Entry>& entries : entriesOf)
    for (const Entry& e : entries) sorted[next[e.leaf]++] = &e;

  // Each leaf for itself. Shares change when all are done: the density that a vertex was sampled with is that
  // of its own leaf, even where it is recorded in another.
  tbb::parallel_for(size_t(0), leaves.size(), [&](size_t l) {
    SdLeaf& leaf = leaves[l];
    for (size_t i = begin[l]; i < begin[l + 1]; ++i) {
      const PathVertex& v = *sorted[i]->vertex;
      const float weight = sorted[i]->weight;
      leaf.weight += weight;
      const float radiance = luminance(v.radiance) / survivingPdf(v);
      leaf.learning.record(directionToCylinder(fromOdis(v.wi)), radiance * weight, m_options.directional);
      if (m_options.bsdfFraction == PpgOptions::BsdfFraction::learned) learnBsdfFraction(v, leaf);
    }
  });
  for (SdLeaf& leaf : leaves) leaf.fraction = 1 / (1 + std::exp(-leaf.bsdfFractionLogit.value()));
}

// A step against the gradient of the Kullback-Leibler divergence between the mixture's density and what it
// should be, radiance * f * cos (Müller 2019, section 10.5). The mixture with the BSDF sampling fraction a is
//   q(a) = q(a0) + (a - a0) (g - P m),   dq/da = g - P m,
// with a0 the fraction, q(a0) the density that the direction was drawn with, g the BSDF's density of guidable
// lobes, P their probability and m the tree's density.
void PracticalPathGuiding::learnBsdfFraction(const PathVertex& v, SdLeaf& leaf) const {
  const Rgb scattered =
      Rgb(v.weight.x, v.weight.y, v.weight.z) * Rgb(v.radiance.x, v.radiance.y, v.radiance.z);
  const float product = luminance(scattered) * v.pdf;
  const DirectionSampler* used = at(fromOdis(v.position), fromOdis(v.normal), true);
  if (!used || !(product > 0)) return;
  const float slope = v.guidablePdf - v.guidableProbability * used->pdf(fromOdis(v.wi));
  const float logit = leaf.bsdfFractionLogit.value(), fraction = 1 / (1 + std::exp(-logit));
  const float density = v.pdf + (fraction - used->bsdfFraction()) * slope;
  const float gradient = -product / (density * v.pdf) * slope * fraction * (1 - fraction);
  if (!(density > 0) || !std::isfinite(gradient)) return;
  leaf.bsdfFractionLogit.step(gradient + kRegularization * logit, kLearningRate, kMaxLogit);
}

void PracticalPathGuiding::endIteration() {
  std::vector<SdLeaf>& leaves = m_tree.leaves();
  tbb::parallel_for(size_t(0), leaves.size(), [&](size_t l) {
    leaves[l].learning.build();
    leaves[l].known = std::move(leaves[l].learning);
    leaves[l].learning = {};
  });
  m_tree.refine(m_options.threshold * std::sqrt(float(1u << std::min(m_iteration, 30))));
  tbb::parallel_for(size_t(0), leaves.size(), [&](size_t l) {
    leaves[l].learning = leaves[l].known.refined(m_options.flux);
    leaves[l].weight = 0;
  });
  ++m_iteration;
}

}  // namespace odis::render
