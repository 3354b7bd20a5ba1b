// How much light a rough dielectric interface lets pass, by numerical integration.
#pragma once

#include <array>
#include <cassert>

#include "render/bsdf/microfacet.h"

namespace odis::render {

class RoughTransmittance {
 public:
  RoughTransmittance(Microfacet::Type type, float alpha, float eta);

  // Share of the light from outside at this cosine (0 if it is not a number) that enters; linear between 64
  // nodes.
  float external(float cosTheta) const {
    const float x = limited(cosTheta, 0.0f, 1.0f) * (kNodes - 1);
    const int i = std::min(int(x), kNodes - 2);
    assert(i >= 0);
    return lerp(x - float(i), m_external[i], m_external[i + 1]);
  }
  // Hemispherical reflectance from inside.
  float internalReflectance() const { return m_internalReflectance; }

 private:
  static constexpr int kNodes = 64;
  std::array<float, kNodes> m_external{};
  float m_internalReflectance = 0;
};

}  // namespace odis::render
