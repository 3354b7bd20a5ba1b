#include "render/rivals/restir_sample.h"

namespace odis::render {

namespace {

// What x2 scatters towards `wo`, times the density of its `wi` there. Linear in both of the sample's
// estimates; the MIS weights between them are those of this very direction.
Rgb scattered(const SecondaryPoint& s, const Vec3& wo) {
  const Bsdf& bsdf = s.at.shape->bsdf();
  const BsdfValue on = bsdf.evaluate(s.at, wo, s.at.shading.toLocal(s.wi));
  if (!(on.pdf > 0)) return {0, 0, 0};
  Rgb sum = on.value * (s.beyond + s.emission * powerHeuristic(on.pdf, s.emissionPdf));
  if (!isBlack(s.light)) {
    const BsdfValue lit = bsdf.evaluate(s.at, wo, s.at.shading.toLocal(s.lightDirection));
    const float weight = s.lightPdf > 0 ? powerHeuristic(s.lightPdf, lit.pdf) : 1;
    sum += lit.value * s.light * (weight * on.pdf);
  }
  return sum;
}

}  // namespace

Worth worthOf(const SecondaryPoint& s, const VisiblePoint& point) {
  Worth worth;
  const Vec3 between = s.at.p - point.at.p;
  worth.distance = length(between);
  if (!(worth.distance > 0)) return worth;
  worth.direction = between * (1 / worth.distance);

  // x1: what the lobes that may be guided scatter, which is their share of all lobes' density.
  const BsdfValue first =
      point.at.shape->bsdf().evaluate(point.at, point.wo, point.at.shading.toLocal(worth.direction));
  if (!(first.guidablePdf > 0) || isBlack(first.value)) return worth;

  // x2 must be seen from the same side: lights were chosen for that one.
  const Vec3 wo = s.at.shading.toLocal(-worth.direction);
  if ((wo.z < 0) != s.back) return worth;
  worth.geometry = absDot(s.at.ng, worth.direction) / sqr(worth.distance);
  worth.value =
      point.throughput * first.value * (first.guidablePdf / first.pdf) * scattered(s, wo) * worth.geometry;
  if (!isFinite(worth.value)) worth.value = Rgb(0, 0, 0);
  return worth;
}

}  // namespace odis::render
