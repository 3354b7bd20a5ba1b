#include "odis/api/reports.h"

#include <cstdio>

#include "odis/api/objects.h"

namespace odis::core {

namespace {

// A number with three digits that count.
std::string threeDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

void warn(OdisContextImpl& context, const std::string& message) {
  context.log(ODIS_LOG_WARNING, message);
}

std::string gainText(double varianceRatio) {
  return "guided samples are predicted to have " + threeDigits(varianceRatio) +
         " of the variance of unguided ones";
}

// How a frame fared that is complete.
std::string summaryText(const Frame& frame) {
  const FrameStatistics s = frame.statistics();
  std::string text = "the frame has ended with " + std::to_string(s.samples) + " samples; ";
  if (s.guidesBuilt == 0) return text + "no guide was built";
  text += countsText(frame.vertexCounts()) + "; ";
  if (s.measuredCostRatio > 0)
    text += "the first guided samples had " + threeDigits(s.measuredCostRatio) +
            " of the variance times the cost of unguided ones; ";
  return text + (s.guidingGivenUp ? "guiding was given up, since it does not pay"
                                  : gainText(s.predictedVarianceRatio));
}

}  // namespace

const std::array<RefusalReason, RefusalWarnings::kReasons>& RefusalWarnings::reasons() {
  static constexpr std::array<RefusalReason, kReasons> kAll = {{
      {&VertexCounts::discrete, "of delta lobes", false},
      {&VertexCounts::notFinite, "with numbers that are not finite", true},
      {&VertexCounts::noDensity, "whose pdf or survival is not positive", true},
      {&VertexCounts::notUnit, "whose normal or wi is no unit vector", true},
      {&VertexCounts::noDepth, "without a depth", true},
      {&VertexCounts::outsideFrame, "of pixels or samples that the pass did not ask for", true},
      {&VertexCounts::wrongSide, "whose normal is on the other side than their wo", true},
      {&VertexCounts::outOfRange, "with a number out of its range", true},
      {&VertexCounts::guidableAbovePdf, "whose guidablePdf is above their pdf, without guidance", true},
      {&VertexCounts::unknownLights, "of a light group that the guide does not have", true},
      {&VertexCounts::twice, "that came before", true},
  }};
  return kAll;
}

void RefusalWarnings::report(OdisContextImpl& context, const VertexCounts& counts) {
  for (size_t i = 0; i < kReasons; ++i) {
    const RefusalReason& reason = reasons()[i];
    const uint64_t count = counts.*reason.count;
    if (!reason.isMistake || count == 0 || m_told[i]) continue;
    m_told[i] = true;
    warn(context, "nothing is learned from vertices " + std::string(reason.words) + ": " +
                      std::to_string(count) + " by now");
  }
}

std::string countsText(const VertexCounts& counts) {
  std::string text = std::to_string(counts.accepted) + " vertices were taken";
  if (counts.inMedia > 0) text += ", " + std::to_string(counts.inMedia) + " of them in media";
  for (const RefusalReason& reason : RefusalWarnings::reasons())
    if (const uint64_t count = counts.*reason.count; count > 0)
      text += ", " + std::to_string(count) + " left out " + reason.words;
  return text;
}

void reportGuide(OdisContextImpl& context, const Guide& guide) {
  const uint32_t cells = guide.view().cellCount;
  std::string text =
      "a guide of " + std::to_string(cells) + " cells, " + std::to_string(guide.bytes()) + " bytes";
  if (cells > 0) text += ": " + gainText(guide.predictedVarianceRatio());
  context.log(ODIS_LOG_INFO, text);
}

void FrameReport::report(OdisContextImpl& context, const Frame& frame, bool verticesLeftOut) {
  const FrameStatistics now = frame.summary();
  const FrameStatistics told = std::exchange(m_told, now);
  if (now.guidesBuilt > told.guidesBuilt && !now.guidingGivenUp) reportGuide(context, frame.guide());
  if (now.passesWithoutVertices > 0 && told.passesWithoutVertices == 0 && !verticesLeftOut)
    warn(context, "a pass that wants vertices got none: nothing is learned from it");
  if (now.missingSamples > 0 && told.missingSamples == 0)
    warn(context, "a pass ended without all of its samples, though it was not interrupted: " +
                      std::to_string(now.missingSamples) + " are missing");
  if (now.notFinite > 0 && told.notFinite == 0)
    warn(context, "samples that are not finite count as black: " + std::to_string(now.notFinite) + " by now");
  if (now.guidingGivenUp && !told.guidingGivenUp)
    context.log(ODIS_LOG_INFO,
                "guiding is given up: " +
                    (now.measuredCostRatio > 0
                         ? "the first guided samples had " + threeDigits(now.measuredCostRatio) +
                               " of the variance times the cost of unguided ones"
                         : std::string("the pilot predicts that it would save next to nothing")));
  if (frame.isComplete() && context.hears(ODIS_LOG_INFO)) context.log(ODIS_LOG_INFO, summaryText(frame));
}

}  // namespace odis::core
