// Maps that a broken or malicious model might make.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "support/models.h"

namespace odis::test {

class AdversarialModel : public core::DirectionModel {
 public:
  enum class Kind { random, oneHot, zero, notANumber, inverted };
  explicit AdversarialModel(Kind kind) : m_kind(kind) {}
  core::DirectionDistribution predict(const core::CellChain& chain,
                                      const core::DirectionDistribution*) const override {
    const core::CellStatistics& cell = *chain[0];
    core::DirectionDistribution result;
    std::mt19937 engine(uint32_t(cell.count) * 7919u + uint32_t(cell.level));
    const float most = *std::max_element(cell.histogram.begin(), cell.histogram.end());
    const uint32_t hot = engine() % kMapTexels;
    for (int t = 0; t < kMapTexels; ++t) {
      result.inverseCosine[t] = 1;
      switch (m_kind) {
        case Kind::random:
          result.probability[t] = float(engine() % 1000) / 1000;
          break;
        case Kind::oneHot:
          result.probability[t] = uint32_t(t) == hot ? 1 : 0;
          break;
        case Kind::zero:
          result.probability[t] = 0;
          break;
        case Kind::notANumber:
          result.probability[t] = engine() % 4 ? 1 : NAN;
          break;
        case Kind::inverted:
          result.probability[t] = most - cell.histogram[t];
          break;
      }
    }
    return result;
  }

 private:
  Kind m_kind;
};

}  // namespace odis::test
