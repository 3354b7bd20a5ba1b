#include <fmt/format.h>

#include <cmath>

#include "learn/inspect/json_values.h"
#include "learn/inspect/picture.h"
#include "learn/inspect/words.h"

namespace odis::learn {

namespace {

std::string number(float value) {
  return std::isnan(value) ? "-" : fmt::format("{:.4g}", value);
}

std::string judgementRow(const std::string& name, const Judgement& j, const Judgement& truth) {
  return fmt::format("{:<22} {:>8.2f} {:>11.3f} {:>9} {:>7} {:>9} {:>6.2g} {:>7}\n", name, j.entropy,
                     j.divergence, number(j.moment), number(j.moment / truth.moment), number(j.bestMoment),
                     j.bestBsdfFraction, number(j.bestMoment / truth.bestMoment));
}

std::string lightName(const render::LightGroup& group) {
  const std::string lights = fmt::format("{} light{}", group.lights, group.lights == 1 ? "" : "s");
  const render::Vec3 at = group.infinite ? group.bounds.axis : (group.bounds.min + group.bounds.max) / 2;
  return fmt::format("{} {} {:.3g},{:.3g},{:.3g}", lights, group.infinite ? "towards" : "around", at.x, at.y,
                     at.z);
}

nlohmann::ordered_json jsonJudgement(const Judgement& j, const Judgement& truth) {
  return {{"entropy", jsonNumber(j.entropy)},
          {"divergence", jsonNumber(j.divergence)},
          {"moment", jsonNumber(j.moment)},
          {"momentRatio", jsonNumber(j.moment / truth.moment)},
          {"bestBsdfFraction", j.bestBsdfFraction},
          {"bestMoment", jsonNumber(j.bestMoment)},
          {"bestMomentRatio", jsonNumber(j.bestMoment / truth.bestMoment)}};
}
nlohmann::ordered_json jsonView(const MapView& view, const Judgement& truth) {
  return {{"name", view.name},
          {"bsdfFraction", view.bsdfFraction},
          {"judgement", jsonJudgement(view.judgement, truth)},
          {"radiance", jsonMap(view.radiance)},
          {"density", jsonMap(view.density)},
          {"mixture", jsonMap(view.mixture)}};
}

}  // namespace

std::string inspectionText(const Inspection& in, const std::string& title) {
  std::string out = title + ": " + placeWords(in) + "\n" + cellWords(in) + "\n\n";
  out += fmt::format("{:<6} {:>8} {:>9} {:>9} {:>10} {:>11} {:>11}\n", "level", "cell", "edge", "samples",
                     "effective", "own weight", "mean value");
  for (const LevelView& l : in.levels)
    out += fmt::format("{:<6} {:>8} {:>9.4g} {:>9.0f} {:>10.1f} {:>11.3f} {:>11.4g}\n", l.statistics.level,
                       l.cell, l.edge, l.statistics.count, l.effective, l.own,
                       l.statistics.sum / std::max(l.statistics.count, 1.0));
  out += "\n";
  for (const std::string& line : decisionWords(in)) out += line + "\n";

  const Judgement& truth = in.converged.judgement;
  out += fmt::format("\n{:<22} {:>8} {:>11} {:>9} {:>7} {:>9} {:>6} {:>7}\n", "map", "entropy", "divergence",
                     "moment", "ratio", "at best", "fraction", "ratio");
  for (const MapView& map : in.maps) out += judgementRow(map.name, map.judgement, truth);
  for (const LevelView& l : in.levels)
    out += judgementRow(fmt::format("histogram of level {}", l.statistics.level), l.judgement, truth);
  out += judgementRow("converged", truth, truth);
  for (const MapView& map : in.maps)
    out += fmt::format("BSDF fraction by {}: {}\n", map.name, fractionWords(map.bsdfFraction));

  if (!in.groups.empty())
    out += fmt::format("\n{:<6} {:<36} {:>9} {:>9} {:>11} {:>11}\n", "group", "lights", "unlearned",
                       "learned", "true mean", "true rms");
  for (size_t g = 0; g < in.groups.size(); ++g) {
    const GroupView& group = in.groups[g];
    out += fmt::format("{:<6} {:<36} {:>9.3f} {:>9.3f} {:>11.4g} {:>11.4g}\n", g, lightName(group.lights),
                       group.unlearned, group.learned, group.converged.misMean, group.converged.misRms);
  }
  return out;
}

nlohmann::ordered_json toJson(const Inspection& in) {
  const Judgement& truth = in.converged.judgement;
  nlohmann::ordered_json levels = nlohmann::ordered_json::array(), maps = nlohmann::ordered_json::array(),
                         groups = nlohmann::ordered_json::array();
  for (const LevelView& l : in.levels)
    levels.push_back({{"level", l.statistics.level},
                      {"cell", l.cell},
                      {"edge", l.edge},
                      {"samples", l.statistics.count},
                      {"effectiveSamples", l.effective},
                      {"ownWeight", jsonNumber(l.own)},
                      {"sum", jsonNumber(l.statistics.sum)},
                      {"judgement", jsonJudgement(l.judgement, truth)},
                      {"histogram", jsonMap(l.histogram)}});
  for (const MapView& map : in.maps) maps.push_back(jsonView(map, truth));
  for (const GroupView& g : in.groups)
    groups.push_back({{"lights", g.lights.lights},
                      {"infinite", g.lights.infinite},
                      {"unlearned", g.unlearned},
                      {"learned", g.learned},
                      {"mean", jsonNumber(g.converged.misMean)},
                      {"rms", jsonNumber(g.converged.misRms)}});
  nlohmann::ordered_json samples = nlohmann::ordered_json::array();
  for (const SampleDot& dot : in.samples) samples.push_back({dot.at.x, dot.at.y, jsonNumber(dot.value)});
  const PathVertex& v = in.vertex;
  return {{"vertex",
           {{"pixel", {in.pixel.x, in.pixel.y}},
            {"depth", v.depth},
            {"position", jsonVector(v.position)},
            {"normal", jsonVector(v.normal)},
            {"roughness", v.roughness},
            {"roughnessClass", className(roughnessClass(GuideRules(), v.roughness))},
            {"guidable", in.guidable},
            {"bsdfFraction", in.bsdfFraction},
            {"pixelValue", jsonNumber(in.pixelValue)},
            {"survival", in.survival}}},
          {"cell",
           {{"bsdfFraction", in.cell.bsdfFraction},
            {"survivalFactor", jsonNumber(in.cell.survivalFactor)},
            {"outgoingRadiance", jsonVector(in.cell.outgoingRadiance)},
            {"learnedLightFraction", in.lightShare}}},
          {"levels", levels},
          {"maps", maps},
          {"converged", jsonView(in.converged, truth)},
          {"reference",
           {{"paths", in.paths},
            {"starts", in.starts},
            {"noise", jsonNumber(in.noise)},
            {"outgoing", jsonVector(in.outgoing)},
            {"outgoingRms", jsonNumber(in.outgoingRms)},
            {"outgoingRays", jsonNumber(in.outgoingRays)}}},
          {"bsdf", jsonMap(in.bsdf)},
          {"best", jsonMap(in.best)},
          {"bsdfAloneMoment", jsonNumber(in.bsdfAlone.moment)},
          {"lightGroups", groups},
          {"samples", samples}};
}

}  // namespace odis::learn
