#include "odis/api/guard.h"

namespace odis::core {

namespace {

// A recorder that this thread opens or closes paths of. It belongs to the thread as long as any is open.
class Ownership {
 public:
  Ownership(OdisRecorderImpl& recorder, const char* function) : m_recorder(recorder) {
    const std::thread::id self = std::this_thread::get_id();
    std::thread::id owner;
    if (!recorder.owner.compare_exchange_strong(owner, self, std::memory_order_acquire) && owner != self)
      throw std::logic_error(std::string(function) +
                             ": another thread has paths of this recorder open: use one for each thread");
  }
  ~Ownership() {
    if (!m_recorder.recorder.hasOpenPaths())
      m_recorder.owner.store(std::thread::id(), std::memory_order_release);
  }
  Ownership(const Ownership&) = delete;
  Ownership& operator=(const Ownership&) = delete;

 private:
  OdisRecorderImpl& m_recorder;
};

// Calls `body` with the recorder, which must not be another thread's. Where it is this thread's, it stays so
// meanwhile: a path is open.
template <class Body>
auto byOwner(OdisRecorderImpl& recorder, const char* function, const Body& body) {
  if (recorder.owner.load(std::memory_order_relaxed) == std::this_thread::get_id())
    return body(recorder.recorder);
  const Ownership ownership(recorder, function);
  return body(recorder.recorder);
}

template <class Record>
bool recordFor(OdisRecorder recorder, const char* function, const Record& record) {
  return guardedFor(recorder, function, false, [&] { return byOwner(*recorder, function, record), true; });
}

// Calls `record` with an event that has all fields, those of the host as far as it knows them.
template <class Event, class Record>
bool recordEvent(OdisRecorder recorder, const Event* event, const char* function, const Record& record) {
  return recordFor(recorder, function, [&](PathRecorder& to) {
    requireArgument(event, function);
    if (event->size == sizeof(Event))
      record(to, *event);
    else
      record(to, adopt(*event, function));
  });
}

}  // namespace

}  // namespace odis::core

using odis::core::byOwner;
using odis::core::guardedFor;
using odis::core::initialize;
using odis::core::Ownership;
using odis::core::PathRecorder;
using odis::core::recordEvent;
using odis::core::recordFor;

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
    return byOwner(*recorder, "odisBeginPath", [&](PathRecorder& to) { return to.begin(*identity); });
  });
}

void odisInitSurfaceEvent(OdisSurfaceEvent* event, size_t size) {
  initialize(event, size, "OdisSurfaceEvent");
}
bool odisRecordSurface(OdisRecorder recorder, uint32_t path, const OdisSurfaceEvent* event) {
  return recordEvent(recorder, event, "odisRecordSurface",
                     [&](PathRecorder& to, const OdisSurfaceEvent& e) { to.surface(path, e); });
}
void odisInitMediumEvent(OdisMediumEvent* event, size_t size) {
  initialize(event, size, "OdisMediumEvent");
}
bool odisRecordMedium(OdisRecorder recorder, uint32_t path, const OdisMediumEvent* event) {
  return recordEvent(recorder, event, "odisRecordMedium",
                     [&](PathRecorder& to, const OdisMediumEvent& e) { to.medium(path, e); });
}
bool odisRecordAttenuation(OdisRecorder recorder, uint32_t path, const OdisFloat3* factor) {
  return recordFor(recorder, "odisRecordAttenuation", [&](PathRecorder& to) {
    odis::core::requireArgument(factor, "odisRecordAttenuation: factor");
    to.attenuation(path, *factor);
  });
}
bool odisRecordEscape(OdisRecorder recorder, uint32_t path) {
  return recordFor(recorder, "odisRecordEscape", [&](PathRecorder& to) { to.escape(path); });
}

void odisInitEmissionEvent(OdisEmissionEvent* event, size_t size) {
  initialize(event, size, "OdisEmissionEvent");
}
bool odisRecordEmission(OdisRecorder recorder, uint32_t path, const OdisEmissionEvent* event) {
  return recordEvent(recorder, event, "odisRecordEmission",
                     [&](PathRecorder& to, const OdisEmissionEvent& e) { to.emission(path, e); });
}
bool odisRecordCachedRadiance(OdisRecorder recorder, uint32_t path, const OdisFloat3* radiance) {
  return recordFor(recorder, "odisRecordCachedRadiance", [&](PathRecorder& to) {
    odis::core::requireArgument(radiance, "odisRecordCachedRadiance: radiance");
    to.cached(path, *radiance);
  });
}
bool odisRecordSurvival(OdisRecorder recorder, uint32_t path, float probability) {
  return recordFor(recorder, "odisRecordSurvival", [&](PathRecorder& to) { to.survived(path, probability); });
}

void odisInitLightEvent(OdisLightEvent* event, size_t size) {
  initialize(event, size, "OdisLightEvent");
}
bool odisRecordLight(OdisRecorder recorder, uint32_t path, const OdisLightEvent* event) {
  return recordEvent(recorder, event, "odisRecordLight",
                     [&](PathRecorder& to, const OdisLightEvent& e) { to.light(path, e); });
}
bool odisRecordLightHidden(OdisRecorder recorder, uint32_t path) {
  return recordFor(recorder, "odisRecordLightHidden", [&](PathRecorder& to) { to.lightHidden(path); });
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
    const Ownership ownership(*recorder, "odisFinishPaths");
    const odis::ArrayView<const OdisPathVertex> vertices = recorder->recorder.finish();
    recorder->memory.set(recorder->recorder.bytes());
    *count = vertices.size();
    return vertices.empty() ? &none : vertices.data();
  });
}
