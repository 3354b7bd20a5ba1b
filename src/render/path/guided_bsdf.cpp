#include "render/path/guided_bsdf.h"

namespace odis::render {

namespace {

// A rival's density as the mixture asks for it.
struct RivalMap {
  const DirectionSampler& rival;
  SamplingMap<float>::Sample sample(float u, float v) const { return rival.sample(Vec2(u, v)); }
  float pdf(const Float3& wi) const { return rival.pdf(fromOdis(wi)); }
};

}  // namespace

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
