// Building the tree: binned, from the root down, by the surface area orientation heuristic.
#include "render/emitter/light_tree.h"

#include <algorithm>

namespace odis::render {

namespace {

constexpr int kBins = 12;
// Below this depth the lights are halved, so that no trail outgrows its 63 turns.
constexpr int kGreatestBinnedDepth = 32;

// The cost of a node: its power times where and whither its lights shine. The bounding sphere stands for the
// box, because importance is judged by it; flat and straight groups of lights have a size then too.
float cost(const LightBounds& b) {
  return b.phi * orientationMeasure(b.thetaO, b.thetaE) * lengthSquared(b.max - b.min);
}

}  // namespace

class LightTree::Build {
 public:
  Build(LightTree& tree, std::span<const LightBounds> lights) : m_tree(tree) {
    for (uint32_t i = 0; i < lights.size(); ++i)
      if (lights[i].phi > 0) m_items.push_back({lights[i], (lights[i].min + lights[i].max) * 0.5f, i});
    m_tree.m_trails.assign(lights.size(), 0);
    if (m_items.empty()) return;
    m_tree.m_pairs.reserve(m_items.size() - 1);
    const Subtree root = node(0, m_items.size(), 0, 0);
    m_tree.m_root = root.link;
    m_tree.m_rootNode = pack(root.bounds, root.link);
  }

 private:
  struct Item {
    LightBounds bounds;
    Vec3 center;
    uint32_t light;
  };
  struct Subtree {
    LightBounds bounds;
    uint32_t link;
  };

  Subtree node(size_t begin, size_t end, uint64_t trail, int depth) {
    if (end - begin == 1) {
      m_tree.m_trails[m_items[begin].light] = trail | uint64_t(1) << depth;
      return {m_items[begin].bounds, kLeaf | m_items[begin].light};
    }
    const size_t middle = split(begin, end, depth);
    const auto pair = uint32_t(m_tree.m_pairs.size());
    m_tree.m_pairs.emplace_back();
    const Subtree first = node(begin, middle, trail, depth + 1);
    const Subtree second = node(middle, end, trail | uint64_t(1) << depth, depth + 1);
    m_tree.m_pairs[pair] = {{pack(first.bounds, first.link), pack(second.bounds, second.link)}};
    return {merged(first.bounds, second.bounds), pair};
  }

  // Parts the lights in two and returns where the second part begins.
  size_t split(size_t begin, size_t end, int depth) {
    Vec3 low = m_items[begin].center, high = low;
    LightBounds box = m_items[begin].bounds;
    for (size_t i = begin; i < end; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], m_items[i].center[axis]);
        high[axis] = std::max(high[axis], m_items[i].center[axis]);
        box.min[axis] = std::min(box.min[axis], m_items[i].bounds.min[axis]);
        box.max[axis] = std::max(box.max[axis], m_items[i].bounds.max[axis]);
      }
    const Vec3 size = box.max - box.min;
    int bestAxis = -1, bestBin = 0;
    if (depth < kGreatestBinnedDepth) {
      float best = kInfinity;
      for (int axis = 0; axis < 3; ++axis) {
        if (!(high[axis] > low[axis])) continue;
        // Cutting across a long side is worth more than cutting across a short one.
        const float regularity = std::max({size.x, size.y, size.z}) / size[axis];
        const auto [bin, value] = bestCut(begin, end, axis, low[axis], high[axis]);
        if (value * regularity >= best) continue;
        best = value * regularity;
        bestAxis = axis;
        bestBin = bin;
      }
    }
    const auto first = m_items.begin() + std::ptrdiff_t(begin), last = m_items.begin() + std::ptrdiff_t(end);
    if (bestAxis >= 0) {
      const auto isFirst = [&](const Item& item) {
        return binOf(item.center[bestAxis], low[bestAxis], high[bestAxis]) <= bestBin;
      };
      const auto middle = std::partition(first, last, isFirst);
      if (middle != first && middle != last) return size_t(middle - m_items.begin());
    }
    // Lights that are all in one place, or too deep a tree: halves along the longest side.
    const Vec3 extent = high - low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [axis](const Item& a, const Item& b) {
      return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.light < b.light;
    });
    return size_t(middle - m_items.begin());
  }

  static int binOf(float x, float low, float high) {
    return int(limited(kBins * ((x - low) / (high - low)), 0.0f, float(kBins - 1)));
  }

  struct Cut {
    int lastBin;  // of the first part
    float cost;
  };
  Cut bestCut(size_t begin, size_t end, int axis, float low, float high) const {
    LightBounds bins[kBins];
    for (size_t i = begin; i < end; ++i) {
      LightBounds& bin = bins[binOf(m_items[i].center[axis], low, high)];
      bin = bin.phi > 0 ? merged(bin, m_items[i].bounds) : m_items[i].bounds;
    }
    float costs[kBins - 1] = {};
    const auto sweep = [&](int from, int to, int step, int offset) {
      LightBounds sum;
      for (int bin = from; bin != to; bin += step) {
        if (bins[bin].phi > 0) sum = sum.phi > 0 ? merged(sum, bins[bin]) : bins[bin];
        if (sum.phi > 0) costs[bin + offset] += cost(sum);
      }
    };
    sweep(0, kBins - 1, 1, 0);
    sweep(kBins - 1, 0, -1, -1);
    const auto best = std::min_element(std::begin(costs), std::end(costs));
    return {int(best - std::begin(costs)), *best};
  }

  LightTree& m_tree;
  std::vector<Item> m_items;
};

LightTree::LightTree(std::span<const LightBounds> lights, uint32_t mostGroups) {
  Build(*this, lights);
  makeGroups(mostGroups);
}

}  // namespace odis::render
