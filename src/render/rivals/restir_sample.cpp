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

Contribution contributionOf(const SecondaryPoint& s, const VisiblePoint& point) {
  Contribution contribution;
  const Vec3 between = s.at.p - point.at.p;
  contribution.distance = length(between);
  if (!(contribution.distance > 0)) return contribution;
  contribution.direction = between * (1 / contribution.distance);

  // x1: what the lobes that may be guided scatter, which is their share of all lobes' density.
  const BsdfValue first =
      point.at.shape->bsdf().evaluate(point.at, point.wo, point.at.shading.toLocal(contribution.direction));
  if (!(first.guidablePdf > 0) || isBlack(first.value)) return contribution;

  // x2 must be seen from the same side: lights were chosen for that one.
  const Vec3 wo = s.at.shading.toLocal(-contribution.direction);
  if ((wo.z < 0) != s.back) return contribution;
  contribution.geometry = absDot(s.at.ng, contribution.direction) / sqr(contribution.distance);
  contribution.value = point.throughput * first.value * (first.guidablePdf / first.pdf) * scattered(s, wo) *
                       contribution.geometry;
  if (!isFinite(contribution.value)) contribution.value = Rgb(0, 0, 0);
  return contribution;
}

}  // namespace odis::render
