// What the emitters of a scene file are made by, and the checks that they share.
#pragma once

#include "render/scene/builder.h"

namespace odis::render {

std::vector<EmitterPtr> makeConstant(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makeDirectional(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makeEnvironmentMap(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makePoint(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makeProjector(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makeSky(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makeSpot(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makeSun(const Properties& node, Builder& builder);
std::vector<EmitterPtr> makeSunSky(const Properties& node, Builder& builder);

// What radiance and the like may be: sums of it and their squares stay finite.
inline constexpr NumberRange kEmissionRange = between(0, 1e15);
// The amount of light that a parameter gives, 1 if it is absent.
Rgb emission(const Properties& node, const std::string& name);
// A scale that multiplies light.
float emissionScale(const Properties& node, const std::string& name, float fallback);
// Throws SceneError if both parameters are given.
void refuseBoth(const Properties& node, const std::string& first, const std::string& second);

}  // namespace odis::render
