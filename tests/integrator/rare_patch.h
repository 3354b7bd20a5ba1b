// A scene with rare light whose image has a mean that is known: what a method to render it must come to.
#pragma once

#include <string>

namespace odis::test {

// A floor that is lit by a patch of the wall beside it, which some .6 % of the paths from the floor find.
struct RarePatch {
  int size = 16;       // pixels a side
  bool crop = false;   // whether they are the middle of an image of twice as many a side
  bool lamps = false;  // whether two dim lamps light floor and wall, too, so that there are lights to choose

  // The scene file. Paths of depth 3 find all of its light.
  std::string text() const;
  // The mean radiance of the image, by quadrature with `points` points a dimension.
  double mean(int points = 16) const;
};

}  // namespace odis::test
