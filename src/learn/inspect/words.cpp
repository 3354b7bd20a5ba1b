#include "learn/inspect/words.h"

#include <fmt/format.h>

#include <cmath>

namespace odis::learn {

namespace {

std::string text(const Float3& v) {
  return fmt::format("{:.4g},{:.4g},{:.4g}", v.x, v.y, v.z);
}
std::string number(float value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

}  // namespace

const char* className(MaterialClass materialClass) {
  constexpr const char* kNames[kMaterialClasses] = {"diffuse", "rough", "glossy"};
  return kNames[int(materialClass)];
}

std::string placeWords(const Inspection& in) {
  const PilotVertex& v = in.vertex;
  return fmt::format("vertex {} of pixel {},{} at {}, normal {}, {} (roughness {:.2g}), guidable {:.2g}",
                     v.depth, in.pixel.x, in.pixel.y, text(v.position), text(v.normal),
                     className(materialClass(v.roughness)), v.roughness, in.guidable);
}

std::string cellWords(const Inspection& in) {
  const LevelView& finest = in.levels.front();
  const int level = finest.statistics.level;
  return fmt::format("cell {}: level {}{}, {:.4g} wide, {:.0f} samples, {:.1f} effective", finest.cell, level,
                     level > 0 ? " (the pilot saw nothing in finer ones)" : "", finest.edge,
                     finest.statistics.count, finest.effective);
}

std::vector<std::string> decisionWords(const Inspection& in) {
  const float* alpha = in.cell.alpha;
  return {fmt::format("alpha: diffuse {:.2g}, rough {:.2g}, glossy {:.2g}; here {:.2g}", alpha[0], alpha[1],
                      alpha[2], in.alpha),
          fmt::format("survival {:.2f} at throughput 1, worth {:.3g}, pixel {:.3g}", in.survival,
                      in.cell.worth, in.pixelValue),
          fmt::format("expected {}", text(in.cell.expected)),
          fmt::format("converged {}, rms {:.3g}, {:.1f} rays", text(in.outgoing), in.outgoingRms,
                      in.outgoingRays),
          fmt::format("lights: {:.0f} % of the choices are learned", 100 * in.lightShare),
          fmt::format("{} paths from {} vertices; noise {:.3f} bits", in.paths, in.starts, in.noise),
          fmt::format("second moment: BSDF alone {}, converged {}", number(in.bsdfAlone.moment),
                      number(in.converged.judgement.moment)),
          fmt::format("at its best alpha {:.2g} converged {}", in.converged.judgement.bestAlpha,
                      number(in.converged.judgement.bestMoment))};
}

std::vector<std::string> mapWords(const Inspection& in, const MapView& map) {
  const Judgement &own = map.judgement, &truth = in.converged.judgement;
  return {fmt::format("entropy {:.2f} bits (converged: {:.2f})", own.entropy, truth.entropy),
          fmt::format("divergence from the converged map {:.3f} bits", own.divergence),
          fmt::format("second moment over squared mean {}: {} x converged's", number(own.moment),
                      number(own.moment / truth.moment)),
          fmt::format("at its best alpha {:.2g}: {}, {} x converged's", own.bestAlpha, number(own.bestMoment),
                      number(own.bestMoment / truth.bestMoment)),
          fmt::format("alpha by this map: diffuse {:.2g}, rough {:.2g}, glossy {:.2g}", map.alpha[0],
                      map.alpha[1], map.alpha[2])};
}

}  // namespace odis::learn
