#include "render/path/guided_bsdf.h"

namespace odis::render {

namespace {

// A rival's density as the mixture asks for it.
struct RivalMap {
  const DirectionSampler& rival;
  VertexMap<float>::Sample sample(float u, float v) const { return rival.sample(Vec2(u, v)); }
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

void GuidedBsdfs::begin(const PathSettings& settings, const Arrival& arrival, bool isDiffuse, size_t lane,
                        MapPreparations& preparations) {
  const auto& [at, wo] = *arrival.vertex;
  const uint32_t cell = arrival.cell;
  if (!(arrival.guidable > 0) || !guidesAt(settings, *arrival.path)) return;
  if (!settings.rival && (cell == kNoCell || !guidesDirections(settings.guide->decisions[cell]))) return;
  const Bsdf& bsdf = at.shape->bsdf();
  const Vec3 normal = facingNormal(at, wo);
  const bool transmissive = bsdf.traits().transmissive;
  if (settings.rival) {
    rivals[lane] = settings.rival->at(at.p, normal, transmissive);
    if (!rivals[lane]) return;
    bsdfFraction[lane] = rivals[lane]->bsdfFraction();
    guidable[lane] = arrival.guidable;
    return;
  }
  const float fraction =
      odis::bsdfFraction(*settings.guide, int32_t(cell), isDiffuse ? 1.0f : bsdf.roughness(at, wo));
  if (fraction >= 1) return;
  bsdfFraction[lane] = fraction;
  guidable[lane] = arrival.guidable;
  hasMap[lane] = anyMap = true;
  preparations.add(maps[lane], int32_t(cell), normal, transmissive ? -1.0f : 0.0f);
}

void GuidedBsdfs::finish(size_t lane) {
  if (!hasMap[lane] || maps[lane].sampleable()) return;
  hasMap[lane] = false;
  bsdfFraction[lane] = 1;
  guidable[lane] = 0;
}

BsdfSample sampleWithoutMap(const GuidedBsdfs& bsdfs, size_t lane, const BsdfHost& host, const Vec2& u) {
  if (!bsdfs.rivals[lane]) return host.sampleBsdf(u.x, u.y);
  return bsdfs.mixture(lane).sample(RivalMap{*bsdfs.rivals[lane]}, u.x, u.y, host);
}

}  // namespace odis::render
