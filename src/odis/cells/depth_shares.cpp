#include "odis/cells/depth_shares.h"

#include <algorithm>
#include <cmath>

#include "odis/cells/samples.h"

namespace odis::core {

namespace {

// Vertices of smaller shares have no part in the cache.
constexpr double kLeastDepthShare = 0.5;
// Deeper vertices are not told apart.
constexpr size_t kMostDepths = 1024;

}  // namespace

void EnergyByDepth::add(const PathVertex& v) {
  if (v.depth == 1) all += luminance(returnedRadiance(v));
  if (v.depth >= kMostDepths || !(v.indirect > 0) || !std::isfinite(v.indirect)) return;
  if (beyond.size() <= v.depth) beyond.resize(v.depth + 1);
  beyond[v.depth] += v.indirect;
}

void EnergyByDepth::add(const EnergyByDepth& more) {
  all += more.all;
  if (beyond.size() < more.beyond.size()) beyond.resize(more.beyond.size());
  for (size_t depth = 0; depth < more.beyond.size(); ++depth) beyond[depth] += more.beyond[depth];
}

void DepthShares::learn(const EnergyByDepth& energy) {
  if (!areUnknown() || !(energy.all > 0)) return;
  const size_t count = std::min<size_t>(energy.beyond.size(), m_maxDepth);
  m_shares.assign(1, 0);
  for (size_t left = 1; left < count; ++left) {
    const double share = std::max(1 - energy.beyond[left] / energy.all, double(m_shares.back()));
    m_shares.push_back(share >= kLeastDepthShare ? float(share) : 0);
  }
}

}  // namespace odis::core
