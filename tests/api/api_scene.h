// What the tests of the C interface share: options, vertices, a frame that is taken through its passes.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <odis/odis.hpp>
#include <string>
#include <vector>

#include "odis/floor_under_patch.h"

namespace odis::test {

// The code of this thread's error, which is forgotten; its message goes to `message`.
inline OdisError takeError(std::string* message = nullptr) {
  const char* text = nullptr;
  const OdisError code = odisGetError(&text);
  if (message) *message = text;
  return code;
}

// Vertices of a floor, as from one pass over 50 x 50 pixels.
inline const std::vector<OdisPathVertex>& apiVertices() {
  static const std::vector<OdisPathVertex> vertices = core::floorUnderPatch(core::kBright, 2500, 3);
  return vertices;
}

// Whether two guides have the same maps and decisions.
inline bool sameBits(const OdisGuideView& a, const OdisGuideView& b) {
  const auto same = [](const auto* x, const auto* y, size_t count) {
    return std::memcmp(x, y, count * sizeof *x) == 0;
  };
  return a.cellCount == b.cellCount && same(a.keys, b.keys, a.cellCount) &&
         same(a.maps, b.maps, a.cellCount * size_t(kMapShares)) &&
         same(a.decisions, b.decisions, a.cellCount);
}

// The density of a direction by the map of a cell.
inline float mapPdfOf(const OdisGuideView& view, uint32_t cell, const Float3& wi) {
  return SamplingMap<float>(view.maps, int32_t(cell)).pdf(wi);
}

// Takes a frame through its passes with made-up samples that each bring one vertex. Ends where a call fails;
// returns whether none did.
inline bool runFrame(OdisFrame frame, uint32_t pixels) {
  OdisFramePass pass;
  while (odisBeginPass(frame, &pass)) {
    std::vector<OdisFrameSample> samples;
    std::vector<OdisPathVertex> vertices;
    for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
      OdisSampleRange range;
      if (!odisGetSamples(frame, pixel, &range)) return false;
      for (uint32_t i = range.first; i < range.first + range.count; ++i) {
        samples.push_back({pixel, i, {1, 1, 1}, 2});
        vertices.push_back(apiVertices()[(pixel * 7 + i) % apiVertices().size()]);
        vertices.back().pixel = pixel;
        vertices.back().sample = i;
      }
    }
    OdisPathVertices described;
    odisDescribeVertices(&described, vertices.data(), vertices.size());
    if (!odisAddSamples(frame, samples.data(), samples.size(), &described)) return false;
    if (!odisEndPass(frame, false)) return false;
  }
  return true;
}

}  // namespace odis::test
