// Embree 3 or 4 behind one set of names: the two differ in how a query's context is passed.
#pragma once

#if ODIS_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace odis::render {

inline void embreeIntersect(RTCScene scene, RTCRayHit& rayHit) {
#if ODIS_EMBREE_MAJOR >= 4
  rtcIntersect1(scene, &rayHit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &rayHit);
#endif
}

inline void embreeIntersect(RTCScene scene, const int* valid, RTCRayHit8& rayHits) {
#if ODIS_EMBREE_MAJOR >= 4
  rtcIntersect8(valid, scene, &rayHits);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect8(valid, scene, &context, &rayHits);
#endif
}

inline void embreeOccluded(RTCScene scene, const int* valid, RTCRay8& rays) {
#if ODIS_EMBREE_MAJOR >= 4
  rtcOccluded8(valid, scene, &rays);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded8(valid, scene, &context, &rays);
#endif
}

inline void embreeOccluded(RTCScene scene, RTCRay& ray) {
#if ODIS_EMBREE_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace odis::render
