#include <fmt/format.h>

#include "learn/inspect/saved_output.h"
#include "learn/inspect/words.h"

namespace odis::learn {

namespace {

std::string fact(const std::string& name, const std::string& value) {
  return fmt::format("{:<24} {}\n", name, value);
}

std::string quantileHead(const std::string& title) {
  return fmt::format("{:<24} {:>10} {:>10} {:>10}\n", title, "10 %", "50 %", "90 %");
}
std::string quantileRow(const std::string& name, const Quantiles& q) {
  return fmt::format("{:<24} {:>10.4g} {:>10.4g} {:>10.4g}\n", name, q.low, q.middle, q.high);
}

std::string levelsText(const std::array<uint32_t, kCellLevels>& cells) {
  uint64_t all = 0;
  std::string levels;
  for (const uint32_t count : cells) {
    all += count;
    levels += fmt::format("{}{}", levels.empty() ? "" : " + ", count);
  }
  return all > 0 ? fmt::format("{} = {}, finest first", all, levels) : "none";
}

// Counts with their reasons; those that are 0 are left out.
std::string countsText(const VertexCounts& c) {
  std::string text = fmt::format("{} taken", c.accepted);
  if (c.inMedia > 0) text += fmt::format(", {} of them in media", c.inMedia);
  const std::pair<const char*, uint64_t> reasons[] = {{"discrete", c.discrete},
                                                      {"not finite", c.notFinite},
                                                      {"without density", c.noDensity},
                                                      {"not unit", c.notUnit},
                                                      {"without depth", c.noDepth},
                                                      {"outside the frame", c.outsideFrame},
                                                      {"on the wrong side", c.wrongSide},
                                                      {"out of range", c.outOfRange},
                                                      {"guidable above pdf", c.guidableAbovePdf},
                                                      {"of unknown lights", c.unknownLights},
                                                      {"twice", c.twice}};
  for (const auto& [name, count] : reasons)
    if (count > 0) text += fmt::format(", {} {}", count, name);
  return text;
}

std::string guideText(const GuideSummary& guide) {
  const GuideView view = guide.guide.view();
  if (view.cellCount == 0) return fact("guide", "none is built yet");
  std::string out = fact("cells", levelsText(guide.cells));
  std::string edges;
  for (int level = 0; level < kCellLevels; ++level)
    edges += fmt::format("{}{:.4g}", level > 0 ? ", " : "", guide.finestEdge * float(1 << level));
  out += fact("their edges", edges);
  out += fact("their cubes", boundsWords(guide.bounds));
  out += fact("memory", fmt::format("{} bytes", guide.guide.bytes()));
  out += fact("groups of lights", std::to_string(view.lightGroups));
  out += fact("predicted variance", fmt::format("{:.3g} of unguided", guide.guide.predictedVarianceRatio()));
  out += "\n" + quantileHead(fmt::format("of {} finest cells", guide.cells[0]));
  for (int c = 0; c < kRoughnessClasses; ++c)
    out += quantileRow(std::string("BSDF fraction, ") + className(c), guide.bsdfFraction[c]);
  out += quantileRow("entropy of the map, bits", guide.entropy);
  out += quantileRow("survival factor", guide.survivalFactor);
  return out + quantileRow("learned-light fraction", guide.learnedLightFraction);
}

std::string cellText(const CellSummary& cell) {
  std::string out = "\n" + savedCellWords(cell) + "\n";
  for (const std::string& line : savedDecisionWords(cell)) out += line + "\n";
  if (cell.lights.empty()) return out;
  out += "learned, by group:";
  for (const float probability : cell.lights) out += fmt::format(" {:.3f}", probability);
  return out + "\n";
}

std::string verticesText(const VertexSummary& v) {
  std::string out = fact("vertices", std::to_string(v.count));
  out += fact("by a builder", countsText(v.counts));
  std::string depths;
  for (size_t i = 0; i < v.depth.size(); ++i) {
    if (v.depth[i] == 0) continue;
    depths += fmt::format("{}{}{}: {}", depths.empty() ? "" : ", ", i + 1, i + 1 < v.depth.size() ? "" : "+",
                          v.depth[i]);
  }
  out += fact("by depth", depths);
  const auto share = [&](uint64_t part) {
    return fmt::format("{:.3g} %", 100 * double(part) / double(std::max<uint64_t>(v.count, 1)));
  };
  out += fact("discrete", share(v.discrete));
  out += fact("scatter to both sides", share(v.scattersBothSides));
  if (v.counts.accepted == 0) return out;
  out += "\n" + fact("those taken lie in", boundsWords(v.bounds));
  out += fact("pixels", fmt::format("{} to {}", v.firstPixel, v.lastPixel));
  out += fact("samples", fmt::format("{} to {}", v.firstSample, v.lastSample));
  out += quantileHead("");
  out += quantileRow("distance", v.distance);
  out += quantileRow("luminance of radiance", v.radiance);
  return out + quantileRow("density", v.pdf);
}

std::string partsText(const BuilderSummary& builder) {
  std::string out;
  for (const PartSummary& part : builder.parts) {
    if (builder.parts.size() > 1) out += fact("part", std::to_string(part.id));
    out += fact("cells of the builder", levelsText(part.cells));
    out += fact("its vertices", countsText(part.counts));
    if (part.coarsening > 1 || part.samplesLeftOut > 0)
      out += fact("to save memory", fmt::format("cells {} times as wide, {} samples left out",
                                                part.coarsening, part.samplesLeftOut));
  }
  return out;
}

std::string builderText(const BuilderSummary& builder) {
  std::string out = fact("model", builder.model);
  for (const ChosenOption& option : builder.options) out += fact("option " + option.name, option.value);
  out += fact("what is added is part", std::to_string(builder.own));
  return out + partsText(builder);
}

std::string frameText(const FrameSummary& f) {
  std::string out = fact("size", fmt::format("{} x {} pixels", f.width, f.height));
  out += fact("state", f.state);
  if (f.tiles > 0) out += fact("tiles of the pass", fmt::format("{} of {} are in", f.tilesDone, f.tiles));
  out += fact("model", f.model);
  for (const ChosenOption& option : f.options) out += fact("option " + option.name, option.value);
  const auto pixels = double(f.image.size());
  const double samples = double(f.samples) / pixels;
  if (f.hasMeans) {
    out += fact("samples of a pixel", fmt::format("{} to {}, mean {:.4g}", f.fewest, f.most, samples));
    out += fact("rays of a sample",
                fmt::format("{:.3g}", f.samples > 0 ? double(f.rays) / double(f.samples) : 0));
    out += fact("mean luminance", fmt::format("{:.6g}", f.luminance));
  } else {
    out += fact("samples of a pixel", fmt::format("mean {:.4g}; the image is the host's", samples));
  }
  out += fact("samples not finite", std::to_string(f.notFinite));
  if (f.pilotVertices)
    out += fact("pilot's vertices",
                fmt::format("{}: {}; {}", f.pilotVertices->count, countsText(f.pilotVertices->counts),
                            boundsWords(f.pilotVertices->bounds)));
  if (f.passVertices) out += fact("vertices of the pass", countsText(*f.passVertices));
  out += fact("guides built", std::to_string(f.guides));
  if (f.builder) {
    out += partsText(*f.builder);
  } else if (f.guides > 0) {
    out += fact("vertices learned from", countsText(f.vertexCounts));
  }
  if (f.hostBytes > 0) out += fact("data of the host", fmt::format("{} bytes", f.hostBytes));
  return out + "\n";
}

}  // namespace

std::string savedText(const SavedInspection& in, const std::string& title) {
  std::string out = fmt::format("{}: {}{}\n", title, in.kind == "vertices" ? "" : "a ", in.kind);
  if (in.frame) out += frameText(*in.frame);
  if (in.guide) out += guideText(*in.guide);
  if (in.cell) out += cellText(*in.cell);
  if (in.builder) out += builderText(*in.builder);
  if (in.vertices) out += verticesText(*in.vertices);
  return out;
}

}  // namespace odis::learn
