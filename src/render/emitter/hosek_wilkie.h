// The tables of Hošek and Wilkie's clear sky and sun. Sources and licence: hosek_wilkie_sky.cpp and
// hosek_wilkie_sun.cpp.
#pragma once

namespace odis::render::hosek_wilkie {

constexpr int kTurbidities = 10;   // of 1 to 10
constexpr int kAlbedos = 2;        // of the ground, 0 and 1
constexpr int kControlPoints = 6;  // of Bézier curves over the cube root of the sun's elevation / 90 degrees
constexpr int kShapeParameters = 9;  // of the paper's F(theta, gamma): A to G, I, H

// F's parameters, and the radiance that F is a share of, integrated with the CIE 1931 observer to linear RGB:
// kCieYIntegral times what a spectrally constant radiance in W/(m^2 sr nm) would give.
constexpr float kCieYIntegral = 106.7502594f;  // nm, of the observer's curve y
extern const float kSkyShape[kTurbidities][kAlbedos][kControlPoints][3][kShapeParameters];
extern const float kSkyRadiance[kTurbidities][kAlbedos][kControlPoints][3];

// Mean radiance of the sun's disc at the elevations 90 (k / 45)^3 degrees, spectral, W/(m^2 sr nm), weighed
// to linear RGB; below 0 where its colour is outside of RGB.
constexpr int kSunKnots = 46;
extern const float kSunRadiance[kTurbidities][kSunKnots][3];

}  // namespace odis::render::hosek_wilkie
