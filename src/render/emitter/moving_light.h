// Lights as they are at a time. What an emitter that moves says of itself it says in its own space.
#pragma once

#include "render/emitter/emitter.h"

namespace odis::render {

EmitterSample sampleMoving(float time, const Emitter& emitter, uint32_t part, const Vec3& ref, const Vec2& u);
float pdfOfMoving(const SurfaceEmitter& emitter, const Vec3& ref, const SurfacePoint& at);
// EnvironmentEmitter::view() at a time, of one direction.
void viewMoving(float time, const EnvironmentEmitter& emitter, EnvironmentView& view);

// Emitter::sample() at a time, as a fraction of the time that the shutter is open.
inline EmitterSample sampleLightAt(float time, const Emitter& emitter, uint32_t part, const Vec3& ref,
                                   const Vec2& u) {
  return emitter.motion() ? sampleMoving(time, emitter, part, ref, u) : emitter.sample(part, ref, u);
}
// SurfaceEmitter::pdf() at the time of the point.
inline float pdfAt(const SurfaceEmitter& emitter, const Vec3& ref, const SurfacePoint& at) {
  return emitter.motion() ? pdfOfMoving(emitter, ref, at) : emitter.pdf(ref, at);
}

// Bounds of a part of an emitter at all times that the shutter is open.
LightBounds boundsWhileOpen(const Emitter& emitter, uint32_t part);

}  // namespace odis::render
