#include "render/sampler/sampler_block.h"

#include <odis/instruction_sets.h>

namespace odis::render {

namespace {

constexpr size_t kSize = SamplerBlock::kSize;

// The loops are short and free of branches, so that compilers turn each into a few vector instructions.

// `y` is null where only the first number of each pair is asked for.
ODIS_WIDE void drawSobol(const uint64_t* bases, const uint32_t* reversedSamples, uint32_t dimension, float* x,
                         float* y) {
  uint64_t hashes[kSize];
  uint32_t indices[kSize];
  const uint64_t ofDimension = mixBits(dimension);
  for (size_t i = 0; i < kSize; ++i) hashes[i] = mixBits(bases[i] ^ ofDimension);
  for (size_t i = 0; i < kSize; ++i) indices[i] = shuffledIndex(reversedSamples[i], uint32_t(hashes[i]));
  for (size_t i = 0; i < kSize; ++i) x[i] = firstSobolNumber(indices[i], uint32_t(hashes[i] >> 32));
  if (!y) return;
  for (size_t i = 0; i < kSize; ++i) y[i] = secondSobolNumber(indices[i], uint32_t(mixBits(hashes[i])));
}

ODIS_WIDE void drawIndependent(const uint64_t* bases, const uint32_t* samples, uint64_t stream, float* x,
                               float* y) {
  uint64_t hashes[kSize];
  for (size_t i = 0; i < kSize; ++i)
    hashes[i] = mixBits(bases[i] ^ mixBits(stream + independentStream(samples[i])));
  for (size_t i = 0; i < kSize; ++i) x[i] = toUnit(uint32_t(hashes[i] >> 32));
  if (!y) return;
  for (size_t i = 0; i < kSize; ++i) y[i] = toUnit(uint32_t(hashes[i]));
}

}  // namespace

void SamplerBlock::add(const Sampler& sampler) {
  assert(m_count < kSize);
  m_kind = sampler.m_kind;
  m_redrawn = sampler.m_redrawn;
  m_bases[m_count] = sampler.m_base;
  m_samples[m_count] = sampler.m_sample;
  m_reversedSamples[m_count] = sampler.m_reversedSample;
  ++m_count;
}

void SamplerBlock::draw1D(uint32_t dimension, Column& x) const {
  draw(dimension, x.of, nullptr);
}

void SamplerBlock::draw2D(uint32_t dimension, Column& x, Column& y) const {
  draw(dimension, x.of, y.of);
}

void SamplerBlock::draw(uint32_t dimension, float* x, float* y) const {
  if (m_kind == SamplerKind::independent)
    drawIndependent(m_bases.data(), m_samples.data(), dimension + redrawnStream(m_redrawn, dimension), x, y);
  else
    drawSobol(m_bases.data(), m_reversedSamples.data(), dimension, x, y);
}

}  // namespace odis::render
