#include "render/emitter/sun_disc.h"

#include "render/math/warp.h"

namespace odis::render {

EmitterSample SunDisc::sample(uint32_t, const Vec3&, const Vec2& u) const {
  // Lambert's azimuthal projection takes areas of the disk to areas of the cap.
  const Vec2 d = squareToDisk(u) * m_chord;
  const float squared = d.x * d.x + d.y * d.y, side = safeSqrt(1 - squared / 4);
  return {.wi = normalize(m_frame.toWorld({d.x * side, d.y * side, 1 - squared / 2})),
          .distance = kInfinity,
          .radiance = m_radiance,
          .pdf = 1 / solidAngle(),
          .delta = false};
}

}  // namespace odis::render
