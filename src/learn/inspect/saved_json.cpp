#include "learn/inspect/json_values.h"
#include "learn/inspect/saved_output.h"

namespace odis::learn {

namespace {

using Json = nlohmann::ordered_json;

Json jsonQuantiles(const Quantiles& q) {
  return {jsonNumber(q.low), jsonNumber(q.middle), jsonNumber(q.high)};
}
Json jsonBounds(const Bounds& box) {
  return {{"low", jsonVector(box.low)}, {"high", jsonVector(box.high)}};
}
Json jsonCounts(const VertexCounts& c) {
  return {{"accepted", c.accepted},
          {"discrete", c.discrete},
          {"notFinite", c.notFinite},
          {"noDensity", c.noDensity},
          {"notUnit", c.notUnit},
          {"noDepth", c.noDepth},
          {"outsideFrame", c.outsideFrame},
          {"wrongSide", c.wrongSide},
          {"outOfRange", c.outOfRange},
          {"guidableAbovePdf", c.guidableAbovePdf},
          {"unknownLights", c.unknownLights},
          {"twice", c.twice},
          {"inMedia", c.inMedia}};
}

Json jsonGuide(const GuideSummary& guide) {
  const GuideView view = guide.guide.view();
  Json fractions = Json::array();
  for (const Quantiles& q : guide.bsdfFraction) fractions.push_back(jsonQuantiles(q));
  return {{"cells", guide.cells},
          {"finestEdge", jsonNumber(guide.finestEdge)},
          {"bounds", jsonBounds(guide.bounds)},
          {"bytes", guide.guide.bytes()},
          {"lightGroups", view.lightGroups},
          {"predictedVarianceRatio", jsonNumber(guide.guide.predictedVarianceRatio())},
          {"quantiles",
           {{"at", {0.1, 0.5, 0.9}},
            {"bsdfFraction", fractions},
            {"entropy", jsonQuantiles(guide.entropy)},
            {"survivalFactor", jsonQuantiles(guide.survivalFactor)},
            {"learnedLightFraction", jsonQuantiles(guide.learnedLightFraction)}}}};
}

Json jsonCell(const CellSummary& cell) {
  return {{"cell", cell.cell},
          {"level", cell.level},
          {"edge", jsonNumber(cell.edge)},
          {"middle", jsonVector(cell.middle)},
          {"normal", jsonVector(cell.normal)},
          {"bsdfFraction", cell.decisions.bsdfFraction},
          {"survivalFactor", jsonNumber(cell.decisions.survivalFactor)},
          {"outgoingRadiance", jsonVector(cell.decisions.outgoingRadiance)},
          {"learnedLightFraction", cell.decisions.learnedLightFraction},
          {"lights", cell.lights},
          {"entropy", cell.entropy},
          {"map", jsonMap(cell.map)}};
}

Json jsonVertices(const VertexSummary& v) {
  return {{"count", v.count},
          {"counts", jsonCounts(v.counts)},
          {"depths", v.depth},
          {"discrete", v.discrete},
          {"scattersBothSides", v.scattersBothSides},
          {"bounds", jsonBounds(v.bounds)},
          {"pixels", {v.firstPixel, v.lastPixel}},
          {"samples", {v.firstSample, v.lastSample}},
          {"quantiles",
           {{"at", {0.1, 0.5, 0.9}},
            {"distance", jsonQuantiles(v.distance)},
            {"radiance", jsonQuantiles(v.radiance)},
            {"pdf", jsonQuantiles(v.pdf)}}}};
}
Json jsonOptions(const std::vector<ChosenOption>& chosen) {
  Json options = Json::object();
  for (const ChosenOption& option : chosen) options[option.name] = option.value;
  return options;
}

Json jsonParts(const BuilderSummary& builder) {
  Json parts = Json::array();
  for (const PartSummary& part : builder.parts)
    parts.push_back({{"id", part.id},
                     {"cells", part.cells},
                     {"counts", jsonCounts(part.counts)},
                     {"unguided", part.unguided},
                     {"coarsening", part.coarsening},
                     {"samplesLeftOut", part.samplesLeftOut}});
  return parts;
}
Json jsonBuilder(const BuilderSummary& builder) {
  return {{"model", builder.model},
          {"options", jsonOptions(builder.options)},
          {"own", builder.own},
          {"parts", jsonParts(builder)}};
}

Json jsonFrame(const FrameSummary& f) {
  Json builder;
  if (f.builder) builder = jsonParts(*f.builder);
  return {{"size", {f.width, f.height}},
          {"state", f.state},
          {"tiles", f.tiles},
          {"tilesDone", f.tilesDone},
          {"model", f.model},
          {"options", jsonOptions(f.options)},
          {"samples", f.samples},
          {"fewestOfAPixel", f.fewest},
          {"mostOfAPixel", f.most},
          {"rays", f.rays},
          {"luminance", jsonNumber(f.luminance)},
          {"notFinite", f.notFinite},
          {"guidesBuilt", f.guides},
          {"vertexCounts", jsonCounts(f.vertexCounts)},
          {"pilotVertices", f.pilotVertices ? jsonVertices(*f.pilotVertices) : Json()},
          {"passVertices", f.passVertices ? jsonCounts(*f.passVertices) : Json()},
          {"builder", builder},
          {"hostBytes", f.hostBytes}};
}

}  // namespace

Json toJson(const SavedInspection& in) {
  Json result{{"kind", in.kind}};
  if (in.frame) result["frame"] = jsonFrame(*in.frame);
  if (in.guide) result["guide"] = jsonGuide(*in.guide);
  if (in.cell) result["cell"] = jsonCell(*in.cell);
  if (in.builder) result["builder"] = jsonBuilder(*in.builder);
  if (in.vertices) result["vertices"] = jsonVertices(*in.vertices);
  return result;
}

}  // namespace odis::learn
