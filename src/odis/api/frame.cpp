#include "odis/api/guard.h"
#include "odis/api/options.h"
#include "odis/api/vertices.h"

namespace odis::core {

namespace {

// A function of a frame that is not on its way between two passes.
template <class Result, class Body>
Result guardedForFrame(OdisFrame frame, const char* function, Result failed, const Body& body) noexcept {
  return guardedFor(frame, function, failed, [&] {
    frame->requireNotEnding(function);
    return body(frame->frame);
  });
}

// Likewise for one that writes to `result`.
template <class Value, class Body>
bool fillFromFrame(OdisFrame frame, const char* function, Value* result, const Body& body) noexcept {
  return guardedForFrame(frame, function, false, [&](const Frame& f) {
    requireArgument(result, function);
    body(f);
    return true;
  });
}

}  // namespace

}  // namespace odis::core

using odis::core::Frame;
using odis::core::guardedFor;
using odis::core::guardedForFrame;

OdisFrameImpl::OdisFrameImpl(OdisContext owner, odis::core::Frame content, OdisGuideBuilder learnsInto)
    : memory(owner), builder(learnsInto), frame(std::move(content)), report(frame.summary()) {
  if (frame.bytes() > owner->memoryLeft()) throw std::bad_alloc();
  memory.set(frame.bytes());
}

OdisFrameImpl::~OdisFrameImpl() {
  if (ending.joinable()) ending.join();
  if (builder && builder->frame == this) builder->frame = nullptr;
}

void OdisFrameImpl::claimBuilder(const char* function) {
  if (!builder) return;
  builder->requireFree(function, this);
  builder->frame = this;
}

void OdisFrameImpl::endPass(bool interrupted) {
  OdisContextImpl& context = memory.context();
  if (context.options.memoryLimit > 0) frame.limitBytes(context.memoryLeft());
  frame.endPass(interrupted);
  memory.set(frame.bytes());
  if (builder)
    builder->takeStock();
  else
    warnings.report(context, frame.coarsening(), frame.samplesLeftOut());
  (builder ? builder->refusals : refusals).report(context, frame.vertexCounts());
  report.report(context, frame, verticesLeftOut);
}

// Whether the memory limit leaves room for this many vertices; warns the first time that it does not.
bool OdisFrameImpl::hasRoomFor(size_t vertices) {
  OdisContextImpl& context = memory.context();
  // Half of the memory is for the guide.
  if (context.options.memoryLimit == 0 ||
      vertices * sizeof(OdisPathVertex) + context.options.memoryLimit / 2 <= context.memoryLeft())
    return true;
  if (!verticesLeftOut.exchange(true))
    context.log(ODIS_LOG_WARNING, "the memory's limit leaves out vertices: the guide learns from the first");
  return false;
}

void OdisFrameImpl::requireNotEnding(const char* function) const {
  if (ending.joinable())
    throw std::logic_error(std::string(function) + ": expected odisWaitForPass after odisStartEndPass");
}

void odisInitFrameOptions(OdisFrameOptions* options, size_t size) {
  odis::core::initialize(options, size, "OdisFrameOptions");
}

OdisFrame odisNewFrame(OdisContext context, const OdisFrameOptions* options) {
  return odis::core::guarded(context, OdisFrame(nullptr), [&] {
    odis::core::requireArgument(context, "odisNewFrame: context");
    odis::core::requireArgument(options, "odisNewFrame: options");
    const odis::core::FrameOptions given = odis::core::optionsOf(*options);
    const OdisGuideBuilder host = odis::core::adopt(*options, "OdisFrameOptions").builder;
    // The frame's reference to the handle keeps its content alive.
    const std::shared_ptr<odis::core::GuideBuilder> builder(std::shared_ptr<void>(),
                                                            host ? &host->builder : nullptr);
    return new OdisFrameImpl(context, Frame(given, context->tasks, builder), host);
  });
}
void odisRetainFrame(OdisFrame frame) {
  if (frame) frame->retain();
}
void odisReleaseFrame(OdisFrame frame) {
  if (frame) frame->release();
}

bool odisBeginPass(OdisFrame frame, OdisFramePass* pass) {
  return guardedForFrame(frame, "odisBeginPass", false, [&](Frame& f) {
    odis::core::requireArgument(pass, "odisBeginPass: pass");
    odis::core::fillIn(*pass, OdisFramePass(), "OdisFramePass");
    frame->claimBuilder("odisBeginPass");
    const OdisFramePass* begun = f.beginPass();
    if (begun) odis::core::fillIn(*pass, *begun, "OdisFramePass");
    return begun != nullptr;
  });
}

bool odisGetSamples(OdisFrame frame, uint32_t pixel, OdisSampleRange* range) {
  return odis::core::fillFromFrame(frame, "odisGetSamples", range,
                                   [&](const Frame& f) { *range = f.samples(pixel); });
}

bool odisWantsVertices(OdisFrame frame, uint32_t pixel) {
  return guardedForFrame(frame, "odisWantsVertices", false,
                         [&](const Frame& f) { return f.wantsVertices(pixel); });
}

const float* odisGetPixelValues(OdisFrame frame) {
  return guardedForFrame(
      frame, "odisGetPixelValues", static_cast<const float*>(nullptr),
      [&](const Frame& f) { return f.pixelValues().empty() ? nullptr : f.pixelValues().data(); });
}

bool odisAddSamples(OdisFrame frame, const OdisFrameSample* samples, size_t count,
                    const OdisPathVertices* vertices) {
  return guardedForFrame(frame, "odisAddSamples", false, [&](Frame& f) {
    if (count > 0) odis::core::requireArgument(samples, "odisAddSamples: samples");
    const odis::core::HostVertices given(vertices);
    if (frame->hasRoomFor(given.size()))
      f.add({samples, count}, given);
    else
      f.add({samples, count});
    frame->memory.set(f.bytes());
    return true;
  });
}

bool odisEndPass(OdisFrame frame, bool interrupted) {
  return guardedForFrame(frame, "odisEndPass", false,
                         [&](Frame&) { return frame->endPass(interrupted), true; });
}

bool odisStartEndPass(OdisFrame frame, bool interrupted) {
  return guardedForFrame(frame, "odisStartEndPass", false, [&](Frame&) {
    frame->ending = std::thread([frame, interrupted] {
      try {
        frame->endPass(interrupted);
      } catch (...) {
        frame->failure = std::current_exception();
      }
    });
    return true;
  });
}

bool odisWaitForPass(OdisFrame frame) {
  return guardedFor(frame, "odisWaitForPass", false, [&] {
    if (!frame->ending.joinable())
      throw std::logic_error("odisWaitForPass: expected odisStartEndPass before");
    frame->ending.join();
    if (const std::exception_ptr failure = std::exchange(frame->failure, nullptr))
      std::rethrow_exception(failure);
    return true;
  });
}

bool odisExtendFrame(OdisFrame frame, uint32_t samplesPerPixel) {
  return guardedForFrame(frame, "odisExtendFrame", false, [&](Frame& f) {
    frame->claimBuilder("odisExtendFrame");
    f.extend(samplesPerPixel);
    frame->memory.set(f.bytes());
    return true;
  });
}

bool odisGuideIsFinal(OdisFrame frame) {
  return guardedForFrame(frame, "odisGuideIsFinal", false, [&](const Frame& f) { return f.guideIsFinal(); });
}

float odisGetSampleWeight(OdisFrame frame, uint32_t pixel, uint32_t sample) {
  return guardedForFrame(frame, "odisGetSampleWeight", 0.0f,
                         [&](const Frame& f) { return f.sampleWeight(pixel, sample); });
}

bool odisGetPixelMean(OdisFrame frame, uint32_t pixel, OdisPixelMean* mean) {
  return odis::core::fillFromFrame(frame, "odisGetPixelMean", mean,
                                   [&](const Frame& f) { *mean = f.mean(pixel); });
}

uint32_t odisGetSampleCount(OdisFrame frame, uint32_t pixel) {
  return guardedForFrame(frame, "odisGetSampleCount", 0u,
                         [&](const Frame& f) { return f.sampleCount(pixel); });
}

bool odisGetFrameStatistics(OdisFrame frame, OdisFrameStatistics* statistics) {
  return odis::core::fillFromFrame(frame, "odisGetFrameStatistics", statistics, [&](const Frame& f) {
    odis::core::fillIn(*statistics, f.statistics(), "OdisFrameStatistics");
  });
}

bool odisGetFrameVertexCounts(OdisFrame frame, OdisVertexCounts* counts) {
  return odis::core::fillFromFrame(frame, "odisGetFrameVertexCounts", counts, [&](const Frame& f) {
    odis::core::fillIn(*counts, f.vertexCounts(), "OdisVertexCounts");
  });
}

OdisGuide odisGetFrameGuide(OdisFrame frame) {
  return guardedForFrame(frame, "odisGetFrameGuide", OdisGuide(nullptr), [&](const Frame& f) {
    return new OdisGuideImpl(&frame->memory.context(), f.guide());
  });
}

const OdisPixelSums* odisGetPilotImage(OdisFrame frame) {
  return guardedForFrame(frame, "odisGetPilotImage", static_cast<const OdisPixelSums*>(nullptr),
                         [&](const Frame& f) { return f.pilotImage().data(); });
}

size_t odisGetPilotVertices(OdisFrame frame, OdisPathVertex* vertices, size_t capacity) {
  return guardedForFrame(frame, "odisGetPilotVertices", size_t(0), [&](const Frame& f) {
    if (!vertices) return f.pilotVertexCount();
    const std::vector<OdisPathVertex> all = f.pilotVertices();
    std::copy_n(all.begin(), std::min(all.size(), capacity), vertices);
    return all.size();
  });
}
