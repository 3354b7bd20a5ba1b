// Whether two guides are the same, bit for bit.
#pragma once

#include <gtest/gtest.h>
#include "odis/guide.h"

#include <cstring>

namespace odis::core {

// Compares so many elements of two arrays, either of which may be null where there are none.
template <class T>
bool sameBits(const T* a, const T* b, size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof(T)) == 0;
}

inline ::testing::AssertionResult sameView(const GuideView& a, const GuideView& b) {
  const auto differ = [](const char* what) { return ::testing::AssertionFailure() << what << " differ"; };
  if (a.version != b.version || a.cellCount != b.cellCount || a.lightGroups != b.lightGroups)
    return differ("versions or sizes");
  static_assert(sizeof(OdisCellGrid) == 20);  // without gaps
  if (!sameBits(&a.grid, &b.grid, 1)) return differ("grids");
  if (!a.slots != !b.slots || (a.slots && a.slotMask != b.slotMask)) return differ("tables' sizes");
  for (uint64_t i = 0; a.slots && i <= a.slotMask; ++i)
    if (a.slots[i].cell != b.slots[i].cell || a.slots[i].key != b.slots[i].key) return differ("tables");
  const size_t cells = a.cellCount;
  if (!sameBits(a.keys, b.keys, cells)) return differ("keys");
  if (!sameBits(a.maps, b.maps, cells * kMapShares)) return differ("maps");
  static_assert(sizeof(CellDecisions) == 32);  // without gaps
  if (!sameBits(a.decisions, b.decisions, cells)) return differ("decisions");
  if (a.lightGroups > 0 && !sameBits(a.lightTables, b.lightTables, cells * (a.lightGroups + 1)))
    return differ("light tables");
  if (!a.cached != !b.cached || (a.cached && !sameBits(a.cached, b.cached, 2 * cells)))
    return differ("cached radiance");
  if (a.pixels.count != b.pixels.count || !sameBits(a.pixels.cells, b.pixels.cells, a.pixels.count))
    return differ("cells of pixels");
  static_assert(sizeof(GuideRules) == 36);  // without gaps
  if (!sameBits(&a.rules, &b.rules, 1)) return differ("rules");
  return ::testing::AssertionSuccess();
}

// The same, with what the guides predict.
inline ::testing::AssertionResult sameGuide(const Guide& a, const Guide& b) {
  if (a.predictedVarianceRatio() != b.predictedVarianceRatio())
    return ::testing::AssertionFailure() << "predicted variances differ";
  return sameView(a.view(), b.view());
}

}  // namespace odis::core
