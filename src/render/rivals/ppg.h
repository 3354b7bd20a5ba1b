// Practical path guiding (Müller, Gross and Novák 2017), with the improvements of Müller 2019 as options.
//
// Iterations take 1, 2, 4, ... samples per pixel, each guided by what the one before it saw; the last one
// takes what is left, up to twice its turn and more. What is learnt is the radiance that arrives, without the
// cosine and without what next-event estimation covers: emitters that a path hits count with their MIS
// weight.
#pragma once

#include "render/rivals/ppg_options.h"
#include "render/rivals/rival.h"
#include "render/rivals/sd_tree.h"

namespace odis::render {

class PracticalPathGuiding final : public Rival {
 public:
  explicit PracticalPathGuiding(const PpgOptions& options) : m_options(options) {}

  const DirectionSampler* at(const Vec3& position, const Vec3& normal, bool scattersBothSides) const override;
  const DirectionSampler* inMedium(const Vec3& position, const Vec3& wo, float meanCosine) const override;

  Combination combination() const override;
  uint32_t iterationEnd(uint32_t done, uint32_t spp) const override;
  void learn(std::span<const std::vector<PathVertex>> tiles, uint32_t sample) override;
  void endIteration() override;
  uint64_t bytes() const override { return m_tree.bytes(); }

 private:
  // A vertex's share in a leaf.
  struct Entry {
    const PathVertex* vertex;
    uint32_t leaf;
    float weight;
  };
  void place(std::span<const std::vector<PathVertex>> tiles);
  void assign(const PathVertex& vertex, uint64_t random, std::vector<Entry>& entries) const;
  void learnBsdfFraction(const PathVertex& vertex, SdLeaf& leaf) const;

  PpgOptions m_options;
  SdTree m_tree;
  bool m_placed = false;
  int m_iteration = 0;
};

}  // namespace odis::render
