#include "learn/inspect/words.h"

#include <fmt/format.h>

#include <cmath>

namespace odis::learn {

namespace {

std::string vectorText(const Float3& v) {
  return fmt::format("{:.4g},{:.4g},{:.4g}", v.x, v.y, v.z);
}
std::string roundedText(float value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

}  // namespace

const char* className(int roughnessClass) {
  constexpr const char* kNames[kRoughnessClasses] = {"diffuse", "rough", "glossy"};
  return kNames[roughnessClass];
}

std::string placeWords(const Inspection& in) {
  const PathVertex& v = in.vertex;
  return fmt::format("vertex {} of pixel {},{} at {}, normal {}, {} (roughness {:.2g}), guidable {:.2g}",
                     v.depth, in.pixel.x, in.pixel.y, vectorText(v.position), vectorText(v.normal),
                     className(roughnessClass(GuideRules(), v.roughness)), v.roughness, in.guidable);
}

std::string cellWords(const Inspection& in) {
  const LevelView& finest = in.levels.front();
  const int level = finest.statistics.level;
  return fmt::format("cell {}: level {}{}, {:.4g} wide, {:.0f} samples, {:.1f} effective", finest.cell, level,
                     level > 0 ? " (the pilot saw nothing in finer ones)" : "", finest.edge,
                     finest.statistics.count, finest.effective);
}

std::vector<std::string> decisionWords(const Inspection& in) {
  const float* bsdfFraction = in.cell.bsdfFraction;
  return {
      fmt::format("BSDF fraction: diffuse {:.2g}, rough {:.2g}, glossy {:.2g}; here {:.2g}", bsdfFraction[0],
                  bsdfFraction[1], bsdfFraction[2], in.bsdfFraction),
      fmt::format("survival {:.2f} at throughput 1, survival factor {:.3g}, pixel {:.3g}", in.survival,
                  in.cell.survivalFactor, in.pixelValue),
      fmt::format("mean outgoing radiance {}", vectorText(in.cell.outgoingRadiance)),
      fmt::format("converged {}, rms {:.3g}, {:.1f} rays", vectorText(in.outgoing), in.outgoingRms,
                  in.outgoingRays),
      fmt::format("lights: {:.0f} % of the choices are learned", 100 * in.lightShare),
      fmt::format("{} paths from {} vertices; noise {:.3f} bits", in.paths, in.starts, in.noise),
      fmt::format("second moment: BSDF alone {}, converged {}", roundedText(in.bsdfAlone.moment),
                  roundedText(in.converged.judgement.moment)),
      fmt::format("at its best BSDF fraction {:.2g} converged {}", in.converged.judgement.bestBsdfFraction,
                  roundedText(in.converged.judgement.bestMoment))};
}

std::vector<std::string> mapWords(const Inspection& in, const MapView& map) {
  const Judgement &own = map.judgement, &truth = in.converged.judgement;
  return {fmt::format("entropy {:.2f} bits (converged: {:.2f})", own.entropy, truth.entropy),
          fmt::format("divergence from the converged map {:.3f} bits", own.divergence),
          fmt::format("second moment over squared mean {}: {} x converged's", roundedText(own.moment),
                      roundedText(own.moment / truth.moment)),
          fmt::format("at its best BSDF fraction {:.2g}: {}, {} x converged's", own.bestBsdfFraction,
                      roundedText(own.bestMoment), roundedText(own.bestMoment / truth.bestMoment)),
          fmt::format("BSDF fraction by this map: diffuse {:.2g}, rough {:.2g}, glossy {:.2g}",
                      map.bsdfFraction[0], map.bsdfFraction[1], map.bsdfFraction[2])};
}

}  // namespace odis::learn
