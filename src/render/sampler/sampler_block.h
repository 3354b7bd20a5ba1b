// The numbers of many paths at once, by vectors where the processor has them.
#pragma once

#include <array>

#include "render/math/columns.h"
#include "render/sampler/sampler.h"

namespace odis::render {

// Up to kSize samplers of one kind with the same purposes redrawn, as those of a pass are. What they draw is
// what each would draw by itself.
class SamplerBlock {
 public:
  static constexpr size_t kSize = kLanes;

  void clear() { m_count = 0; }
  void add(const Sampler& sampler);

  // The numbers of a dimension, which counts from 1: those of get1D() and get2D(), in the order of add(). The
  // rest of a column is undefined.
  void draw1D(uint32_t dimension, Column& x) const;
  void draw2D(uint32_t dimension, Column& x, Column& y) const;

 private:
  void draw(uint32_t dimension, float* x, float* y) const;  // `y` may be null

  size_t m_count = 0;
  SamplerKind m_kind = SamplerKind::sobol;
  Purposes m_redrawn = 0;
  std::array<uint64_t, kSize> m_bases{};
  std::array<uint32_t, kSize> m_samples{}, m_reversedSamples{};
};

}  // namespace odis::render
