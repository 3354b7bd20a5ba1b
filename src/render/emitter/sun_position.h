// Where the sun stands at a time and place.
#pragma once

#include "render/math/vec.h"

namespace odis::render {

struct TimeAndPlace {
  int year = 2010, month = 7, day = 10;
  double hour = 15, minute = 0, second = 0;         // local time
  double latitude = 35.6894, longitude = 139.6917;  // degrees, north and east positive; Tokyo
  double timezone = 9;                              // hours that local time is ahead of universal time
};

// Angles in radians: from the zenith, and from north over east.
struct SunPosition {
  double zenith;
  double azimuth;
};

// The PSA algorithm: Blanco-Muriel, Alarcón-Padilla, López-Moratalla, Lara-Coira, "Computing the Solar
// Vector", Solar Energy 70(5), 2001. Good to half an arc minute from 1999 to 2015, and to a few arc minutes
// within decades of that.
SunPosition sunPosition(const TimeAndPlace& when);

}  // namespace odis::render
