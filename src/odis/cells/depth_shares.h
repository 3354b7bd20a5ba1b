// How much of what vertices scatter back a path still finds that max_depth is about to end.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "odis/path_vertex.h"

namespace odis::core {

// What the vertices of each depth add to the image: what they scatter themselves at depth 1, and what is
// scattered beyond them at every depth.
class EnergyByDepth {
 public:
  void add(const PathVertex& vertex);
  void add(const EnergyByDepth& more);

  double all = 0;
  std::vector<double> beyond;  // [depth]
};

// The shares of a limit of depth, 0: none. A vertex that may be followed by r - 1 others scatters back what
// comes from so many bounces; the share is that over what comes from as many as a path's first vertex may
// be followed by. Vertices of small shares differ too much from place to place: they count as 0.
class DepthShares {
 public:
  explicit DepthShares(uint32_t maxDepth = 0) : m_maxDepth(maxDepth) {}

  // Learns them from unguided paths, once: what comes later is divided by the same shares.
  void learn(const EnergyByDepth& energy);
  // Takes those that were learned before.
  void set(std::span<const float> shares) { m_shares.assign(shares.begin(), shares.end()); }

  // Whether there are any to be learned.
  bool areUnknown() const { return m_maxDepth > 0 && m_shares.empty(); }

  // Of a vertex at this depth; 1 where nothing was learned.
  float of(uint32_t depth) const {
    if (m_shares.empty()) return 1;
    const uint32_t left = depth < m_maxDepth ? m_maxDepth - depth : 0;
    return left < m_shares.size() ? m_shares[left] : 1;
  }
  uint32_t maxDepth() const { return m_maxDepth; }
  // [bounces left], 1 beyond.
  std::span<const float> shares() const { return m_shares; }

 private:
  uint32_t m_maxDepth;
  std::vector<float> m_shares;
};

}  // namespace odis::core
