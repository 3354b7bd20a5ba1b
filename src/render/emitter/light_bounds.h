// Where lights are and where they shine, for choosing among many of them.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

// Bounds of one light or of several: all emitting points lie in the box, all their normals within thetaO of
// the axis, and no light leaves at more than thetaE from a normal (Conty Estevez and Kulla 2018, "Importance
// Sampling of Many Lights with Adaptive Tree Splitting").
struct LightBounds {
  Vec3 min, max;
  Vec3 axis{0, 0, 1};      // unit
  float thetaO = 0;        // radians, up to pi
  float thetaE = kPi / 2;  // radians, up to pi
  float phi = 0;           // power / pi (W/sr): of a flat diffuse light the intensity along its normal
};

// Bounds of both.
LightBounds merged(const LightBounds& a, const LightBounds& b);

// The intensity of lights of phi = 1 towards their axis, with normals spread evenly over a cone of half-angle
// thetaO: 1 for a flat light, 1/4 if they look everywhere.
float axialIntensity(float thetaO);

// The measure of the directions that such lights shine into, weighted by the cosine beyond thetaO: the
// orientation term of the surface area orientation heuristic.
float orientationMeasure(float thetaO, float thetaE);

}  // namespace odis::render
