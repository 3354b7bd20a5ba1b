#include "learn/inspect/words.h"

#include <fmt/format.h>

#include <cmath>

namespace odis::learn {

namespace {

std::string roundedText(float value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

}  // namespace

std::string vectorText(const Float3& v) {
  return fmt::format("{:.4g},{:.4g},{:.4g}", v.x, v.y, v.z);
}

const char* className(int roughnessClass) {
  constexpr const char* kNames[kRoughnessClasses] = {"diffuse", "rough", "glossy"};
  return kNames[roughnessClass];
}

std::string boundsWords(const Bounds& b) {
  return b.low.x <= b.high.x ? vectorText(b.low) + " to " + vectorText(b.high) : "nowhere";
}

std::string fractionWords(const float* ofClasses) {
  return fmt::format("diffuse {:.2g}, rough {:.2g}, glossy {:.2g}", ofClasses[0], ofClasses[1], ofClasses[2]);
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
  return {
      fmt::format("BSDF fraction: {}; here {:.2g}", fractionWords(in.cell.bsdfFraction), in.bsdfFraction),
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

std::string savedCellWords(const CellSummary& cell) {
  return fmt::format("cell {}: level {}, {:.4g} wide around {}, facing {}", cell.cell, cell.level, cell.edge,
                     vectorText(cell.middle), vectorText(cell.normal));
}

std::vector<std::string> savedDecisionWords(const CellSummary& cell) {
  const CellDecisions& d = cell.decisions;
  return {"BSDF fraction: " + fractionWords(d.bsdfFraction),
          fmt::format("survival factor {:.3g}; mean outgoing radiance {}", d.survivalFactor,
                      vectorText(d.outgoingRadiance)),
          fmt::format("lights: {:.0f} % of the choices are learned", 100 * d.learnedLightFraction),
          fmt::format("entropy {:.2f} bits", cell.entropy)};
}

std::vector<std::string> mapWords(const Inspection& in, const MapView& map) {
  const Judgement &own = map.judgement, &truth = in.converged.judgement;
  return {fmt::format("entropy {:.2f} bits (converged: {:.2f})", own.entropy, truth.entropy),
          fmt::format("divergence from the converged map {:.3f} bits", own.divergence),
          fmt::format("second moment over squared mean {}: {} x converged's", roundedText(own.moment),
                      roundedText(own.moment / truth.moment)),
          fmt::format("at its best BSDF fraction {:.2g}: {}, {} x converged's", own.bestBsdfFraction,
                      roundedText(own.bestMoment), roundedText(own.bestMoment / truth.bestMoment)),
          "BSDF fraction by this map: " + fractionWords(map.bsdfFraction)};
}

}  // namespace odis::learn
