// Models that decide against all that cells have seen.
#pragma once

#include <cmath>
#include <random>

#include "odis/models/direction_model.h"
#include "odis/models/lights.h"
#include "support/models.h"

namespace odis::test {

// Maps that have nothing to do with the light.
class WrongDirections : public core::DirectionModel {
 public:
  enum class Kind { random, oneTexel, zero, notANumber };
  explicit WrongDirections(Kind kind) : m_kind(kind) {}
  core::DirectionDistribution predict(const core::CellChain& chain,
                                      const core::DirectionDistribution*) const override {
    std::mt19937 engine(uint32_t(chain[0]->count) * 7919u + uint32_t(chain[0]->level));
    const uint32_t bright = engine() % kMapTexels;
    core::DirectionDistribution result;
    for (uint32_t t = 0; t < kMapTexels; ++t) {
      result.inverseCosine[t] = 1;
      result.probability[t] = m_kind == Kind::random       ? float(engine() % 1000) / 1000
                              : m_kind == Kind::oneTexel   ? float(t == bright)
                              : m_kind == Kind::notANumber ? (engine() % 4 == 0 ? NAN : 1.0f)
                                                           : 0;
    }
    return result;
  }

 private:
  Kind m_kind;
};

// Tables that draw one lamp only, or numbers that make no table.
class WrongLights : public core::LightModel {
 public:
  core::LightSquares predict(const core::CellChain& chain, const core::LightSquares*,
                             uint32_t) const override {
    std::mt19937 engine(uint32_t(chain[0]->count) * 104729u + uint32_t(chain[0]->level));
    core::LightSquares result{};
    const uint32_t kind = engine() % 3;
    result[engine() % 2] = kind == 0 ? 1 : kind == 1 ? NAN : -1;
    return result;
  }
  double reliability(const core::CellChain&, uint32_t) const override { return 0.9; }
};

// The same options with such models, which most directions follow.
inline FrameOptions decidedWrongly(FrameOptions options, WrongDirections::Kind kind) {
  options.guide.model = makeModel(std::make_shared<WrongDirections>(kind), std::make_shared<WrongLights>());
  options.guide.set("bsdf-fraction=0.3");
  return options;
}

}  // namespace odis::test
