#include "render/path/guided_bsdf.h"

namespace odis::render {

void GuidedBsdfs::clear() {
  std::fill_n(bsdfFraction.of, kLanes, 1.0f);
  guidable = {};
  hasMap = {};
  rivals.fill(nullptr);
  anyMap = false;
}

BsdfSample sampleWithoutMap(const GuidedBsdfs& bsdfs, size_t lane, const BsdfHost& host, const Vec2& u) {
  if (!bsdfs.rivals[lane]) return host.sampleBsdf(u.x, u.y);
  return bsdfs.mixture(lane).sample(RivalMap{*bsdfs.rivals[lane]}, u.x, u.y, host);
}

}  // namespace odis::render
