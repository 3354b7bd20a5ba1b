#include "odis/api/guard.h"
#include "odis/api/options.h"
#include "odis/api/vertices.h"

using odis::core::guardedFor;
using odis::core::HostVertices;

OdisGuideImpl::OdisGuideImpl(OdisContext owner, odis::core::Guide content)
    : memory(owner), guide(std::move(content)) {
  memory.set(guide.bytes());
}

OdisGuideBuilderImpl::OdisGuideBuilderImpl(OdisContext owner, odis::core::GuideBuilder content)
    : memory(owner), builder(std::move(content)) {
  memory.set(builder.heldBytes());
}

void OdisGuideBuilderImpl::takeStock() {
  memory.set(builder.heldBytes());
  warnings.report(memory.context(), builder.coarsening(), builder.samplesLeftOut());
}

void OdisGuideBuilderImpl::requireFree(const char* function, const OdisFrameImpl* of) const {
  if (frame && frame != of && !frame->frame.isComplete())
    throw std::logic_error(std::string(function) +
                           ": a frame that has not ended learns into this builder, expected it to end first");
}

void odisInitGuideOptions(OdisGuideOptions* options, size_t size) {
  odis::core::initialize(options, size, "OdisGuideOptions");
}

OdisGuideBuilder odisNewGuideBuilder(OdisContext context, const OdisGuideOptions* options) {
  return odis::core::guarded(context, OdisGuideBuilder(nullptr), [&] {
    odis::core::requireArgument(context, "odisNewGuideBuilder: context");
    const auto given = options ? odis::core::optionsOf(*options) : odis::core::GuideOptions();
    return new OdisGuideBuilderImpl(context, odis::core::GuideBuilder(given, context->tasks));
  });
}
void odisRetainGuideBuilder(OdisGuideBuilder builder) {
  if (builder) builder->retain();
}
void odisReleaseGuideBuilder(OdisGuideBuilder builder) {
  if (builder) builder->release();
}

bool odisAddVertices(OdisGuideBuilder builder, const OdisPathVertices* vertices, bool guided) {
  return guardedFor(builder, "odisAddVertices", false, [&] {
    odis::core::requireArgument(vertices, "odisAddVertices: vertices");
    builder->requireFree("odisAddVertices");
    HostVertices given(vertices);
    OdisContextImpl& context = builder->memory.context();
    if (context.options.memoryLimit > 0)
      builder->builder.limitBytes(context.memoryLeft() + builder->builder.heldBytes(), given.size());
    const odis::ArrayView<const odis::PathVertex> all = given.view();
    guided ? builder->builder.addGuided(all) : builder->builder.add(all);
    builder->memory.set(builder->builder.bytes());
    builder->takeStock();
    builder->refusals.report(context, builder->builder.vertexCounts());
    return true;
  });
}

namespace odis::core {

namespace {

// A handle of a guide that a builder has built.
OdisGuide newBuiltGuide(OdisGuideBuilder builder, Guide guide) {
  OdisContextImpl& context = builder->memory.context();
  reportGuide(context, guide);
  return new OdisGuideImpl(&context, std::move(guide));
}

}  // namespace

}  // namespace odis::core

OdisGuide odisBuildGuide(OdisGuideBuilder builder, const float* pixelValues, size_t pixelCount) {
  return guardedFor(builder, "odisBuildGuide", OdisGuide(nullptr), [&] {
    builder->requireFree("odisBuildGuide");
    if (pixelCount > 0) odis::core::requireArgument(pixelValues, "odisBuildGuide: pixelValues");
    return odis::core::newBuiltGuide(builder,
                                     builder->builder.build({pixelValues, pixelValues ? pixelCount : 0}));
  });
}

OdisGuide odisRebuildGuide(OdisGuideBuilder builder, OdisGuide previous) {
  return guardedFor(builder, "odisRebuildGuide", OdisGuide(nullptr), [&] {
    odis::core::requireArgument(previous, "odisRebuildGuide: previous");
    builder->requireFree("odisRebuildGuide");
    return odis::core::newBuiltGuide(builder, builder->builder.rebuild(previous->guide));
  });
}

bool odisFadeVertices(OdisGuideBuilder builder, float weight) {
  return guardedFor(builder, "odisFadeVertices", false, [&] {
    builder->requireFree("odisFadeVertices");
    builder->builder.fade(weight);
    builder->takeStock();
    return true;
  });
}

bool odisForgetVertices(OdisGuideBuilder builder) {
  return guardedFor(builder, "odisForgetVertices", false, [&] {
    builder->requireFree("odisForgetVertices");
    builder->builder.forget();
    builder->takeStock();
    return true;
  });
}

bool odisSetBounds(OdisGuideBuilder builder, const OdisFloat3* lower, const OdisFloat3* upper) {
  return guardedFor(builder, "odisSetBounds", false, [&] {
    odis::core::requireArgument(lower, "odisSetBounds: lower");
    odis::core::requireArgument(upper, "odisSetBounds: upper");
    builder->requireFree("odisSetBounds");
    builder->builder.setBounds(*lower, *upper);
    builder->takeStock();
    return true;
  });
}

bool odisSetPartId(OdisGuideBuilder builder, uint64_t id) {
  return guardedFor(builder, "odisSetPartId", false, [&] {
    builder->requireFree("odisSetPartId");
    builder->builder.setPartId(id);
    return true;
  });
}

bool odisMergeGuideBuilders(OdisGuideBuilder into, const OdisGuideBuilder* builders, size_t count) {
  return guardedFor(into, "odisMergeGuideBuilders", false, [&] {
    if (count > 0) odis::core::requireArgument(builders, "odisMergeGuideBuilders: builders");
    into->requireFree("odisMergeGuideBuilders");
    std::vector<const odis::core::GuideBuilder*> others;
    uint64_t bytes = 0;
    for (size_t i = 0; i < count; ++i) {
      odis::core::requireArgument(builders[i], "odisMergeGuideBuilders: builders");
      builders[i]->requireFree("odisMergeGuideBuilders");
      others.push_back(&builders[i]->builder);
      bytes += builders[i]->builder.heldBytes();
    }
    if (bytes > into->memory.context().memoryLeft()) throw std::bad_alloc();
    into->builder.merge(others);
    into->takeStock();
    return true;
  });
}

bool odisGetVertexCounts(OdisGuideBuilder builder, OdisVertexCounts* counts) {
  return guardedFor(builder, "odisGetVertexCounts", false, [&] {
    odis::core::requireArgument(counts, "odisGetVertexCounts: counts");
    odis::core::fillIn(*counts, builder->builder.vertexCounts(), "OdisVertexCounts");
    return true;
  });
}

uint64_t odisGetGuideBuilderBytes(OdisGuideBuilder builder) {
  return guardedFor(builder, "odisGetGuideBuilderBytes", uint64_t(0),
                    [&] { return builder->builder.bytes(); });
}

void odisRetainGuide(OdisGuide guide) {
  if (guide) guide->retain();
}
void odisReleaseGuide(OdisGuide guide) {
  if (guide) guide->release();
}
uint64_t odisGetGuideBytes(OdisGuide guide) {
  return guardedFor(guide, "odisGetGuideBytes", uint64_t(0), [&] { return guide->guide.bytes(); });
}
float odisGetPredictedVarianceRatio(OdisGuide guide) {
  return guardedFor(guide, "odisGetPredictedVarianceRatio", 1.0f,
                    [&] { return guide->guide.predictedVarianceRatio(); });
}
bool odisGetGuideView(OdisGuide guide, OdisGuideView* view) {
  return guardedFor(guide, "odisGetGuideView", false, [&] {
    odis::core::requireArgument(view, "odisGetGuideView: view");
    odis::core::fillIn(*view, guide->guide.view(), "OdisGuideView");
    return true;
  });
}
