// Light from outside.
#pragma once

#include "learn/scenes/draft.h"

namespace odis::learn {

// A clear sky with a sun, an overcast one, a drawn one or one of the user's; `toSun` is where the sun is
// best, a unit vector above the horizon.
void addSky(Draft& draft, const Vec3& toSun);
// A sun and a clear sky, for certain.
void addDaylight(Draft& draft, const Vec3& toSun, float sunScale);
// What is to be seen of the world: a plain `below` metres under the floor, houses on it by chance.
void addSurroundings(Draft& draft, const Box& building, float below);

// A direction above the horizon by azimuth and elevation (radians).
Vec3 skyDirection(double azimuth, double elevation);

// A drawn sky as a HDR file: gradient, clouds, a blurred sun, a ground; or a city's lights at night.
std::string drawSky(Random random, const Vec3& toSun);

}  // namespace odis::learn
