#include "odis/api/guard.h"

namespace odis::core {

namespace {

// Calls `record` with an event that has all fields, those of the host as far as it knows them.
template <class Event, class Record>
bool recordEvent(OdisRecorder recorder, const Event* event, const char* function, const Record& record) {
  return guardedFor(recorder, function, false, [&] {
    requireArgument(event, function);
    if (event->size == sizeof(Event))
      record(recorder->recorder, *event);
    else
      record(recorder->recorder, adopt(*event, function));
    return true;
  });
}

}  // namespace

}  // namespace odis::core

using odis::core::guardedFor;
using odis::core::initialize;
using odis::core::PathRecorder;
using odis::core::recordEvent;

OdisRecorder odisNewRecorder(OdisContext context) {
  return odis::core::guarded(context, OdisRecorder(nullptr), [&] {
    odis::core::requireArgument(context, "odisNewRecorder");
    return new OdisRecorderImpl(context);
  });
}
void odisRetainRecorder(OdisRecorder recorder) {
  if (recorder) recorder->retain();
}
void odisReleaseRecorder(OdisRecorder recorder) {
  if (recorder) recorder->release();
}

uint32_t odisBeginPath(OdisRecorder recorder, const OdisPathIdentity* identity) {
  return guardedFor(recorder, "odisBeginPath", UINT32_MAX, [&] {
    odis::core::requireArgument(identity, "odisBeginPath: identity");
    return recorder->recorder.begin(*identity);
  });
}

void odisInitSurfaceEvent(OdisSurfaceEvent* event, size_t size) {
  initialize(event, size, "OdisSurfaceEvent");
}
bool odisRecordSurface(OdisRecorder recorder, uint32_t path, const OdisSurfaceEvent* event) {
  return recordEvent(recorder, event, "odisRecordSurface",
                     [&](PathRecorder& to, const OdisSurfaceEvent& e) { to.surface(path, e); });
}
bool odisRecordEscape(OdisRecorder recorder, uint32_t path) {
  return guardedFor(recorder, "odisRecordEscape", false,
                    [&] { return recorder->recorder.escape(path), true; });
}

void odisInitEmissionEvent(OdisEmissionEvent* event, size_t size) {
  initialize(event, size, "OdisEmissionEvent");
}
bool odisRecordEmission(OdisRecorder recorder, uint32_t path, const OdisEmissionEvent* event) {
  return recordEvent(recorder, event, "odisRecordEmission",
                     [&](PathRecorder& to, const OdisEmissionEvent& e) { to.emission(path, e); });
}
bool odisRecordCachedRadiance(OdisRecorder recorder, uint32_t path, const OdisFloat3* radiance) {
  return guardedFor(recorder, "odisRecordCachedRadiance", false, [&] {
    odis::core::requireArgument(radiance, "odisRecordCachedRadiance: radiance");
    return recorder->recorder.cached(path, *radiance), true;
  });
}
bool odisRecordSurvival(OdisRecorder recorder, uint32_t path, float probability) {
  return guardedFor(recorder, "odisRecordSurvival", false,
                    [&] { return recorder->recorder.survived(path, probability), true; });
}

void odisInitLightEvent(OdisLightEvent* event, size_t size) {
  initialize(event, size, "OdisLightEvent");
}
bool odisRecordLight(OdisRecorder recorder, uint32_t path, const OdisLightEvent* event) {
  return recordEvent(recorder, event, "odisRecordLight",
                     [&](PathRecorder& to, const OdisLightEvent& e) { to.light(path, e); });
}
bool odisRecordLightHidden(OdisRecorder recorder, uint32_t path) {
  return guardedFor(recorder, "odisRecordLightHidden", false,
                    [&] { return recorder->recorder.lightHidden(path), true; });
}

void odisInitBounceEvent(OdisBounceEvent* event, size_t size) {
  initialize(event, size, "OdisBounceEvent");
}
bool odisRecordBounce(OdisRecorder recorder, uint32_t path, const OdisBounceEvent* event) {
  return recordEvent(recorder, event, "odisRecordBounce",
                     [&](PathRecorder& to, const OdisBounceEvent& e) { to.bounce(path, e); });
}

const OdisPathVertex* odisFinishPaths(OdisRecorder recorder, size_t* count) {
  static const OdisPathVertex none;
  return guardedFor(recorder, "odisFinishPaths", static_cast<const OdisPathVertex*>(nullptr), [&] {
    odis::core::requireArgument(count, "odisFinishPaths: count");
    const odis::ArrayView<const OdisPathVertex> vertices = recorder->recorder.finish();
    recorder->memory.set(recorder->recorder.bytes());
    *count = vertices.size();
    return vertices.empty() ? &none : vertices.data();
  });
}
