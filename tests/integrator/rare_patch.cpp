// The mean of the image is an integral over the visible square of the floor, S:
//
//   mean = 1/|S| ∫_S ρ_floor/π [ E_lamps(x) + ∫_wall L(y) cos θ_x cos θ_y / |x − y|² dy ] dx,
//   L(y) = ρ_wall/π [ E_spot(y) + E_lamps(y) ],
//
// E being irradiance. The camera looks straight down, so that the pixels' samples are uniform on S. No
// other path has light: floor and wall are flat, the spot misses the floor, paths end with depth 3. Nothing
// hides anything. The spot's light has kinks at the rims of its beam and of its cone, the lamps' has none. So
// each is integrated on its own: the spot in polar coordinates between the rims, the lamps over the wall.
#include "integrator/rare_patch.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "integrator/test_scenes.h"

namespace odis::test {

namespace {

constexpr double kPi = std::numbers::pi, kDegree = kPi / 180;

constexpr double kCameraHeight = 4, kFov = 8 * kDegree;
constexpr double kFloorReflectance = 0.5, kWallReflectance = 0.9;
// The wall is the rectangle x = kWallX, |y − kWallY| <= kWallHalfHeight, |z| <= kWallHalfWidth.
constexpr double kWallX = 1, kWallY = 0.6, kWallHalfHeight = 0.4, kWallHalfWidth = 0.6;
// The spot shines at the wall's middle from straight in front of it. It is full within the beam and falls to
// nothing at the cutoff, linearly in the angle.
constexpr double kSpotDistance = 4, kSpotIntensity = 400, kCutoff = 2.5 * kDegree, kBeam = 0.75 * kCutoff;

struct Lamp {
  double x, y, z, intensity;
};
constexpr Lamp kLamps[] = {{-0.3, 1, 0.4, 0.003}, {0.5, 0.5, -0.3, 0.001}};

struct Node {
  double x, weight;
};

// Gauss-Legendre quadrature over [from, to]. The nodes are the roots of Legendre's polynomial, which Newton's
// method finds.
std::vector<Node> gauss(int points, double from, double to) {
  std::vector<Node> nodes;
  for (int i = 0; i < points; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int step = 0; step < 10; ++step) {
      double previous = 1, value = x;
      for (int n = 2; n <= points; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * previous) / n;
        previous = value;
        value = next;
      }
      slope = points * (x * value - previous) / (x * x - 1);
      x -= value / slope;
    }
    const double weight = 2 / ((1 - x * x) * slope * slope);
    nodes.push_back({(from + to) / 2 + x * (to - from) / 2, weight * (to - from) / 2});
  }
  return nodes;
}

// A small piece of the wall at (kWallX, y, z), and the power per solid angle that it sends along its normal.
struct WallPiece {
  double y, z, intensity;
};

void addSpot(std::vector<WallPiece>& pieces, int points) {
  const auto addRing = [&](double from, double to, auto falloff) {
    for (const Node& theta : gauss(points, from, to))
      for (int i = 0; i < 2 * points; ++i) {  // equal steps around: the integrand is periodic
        const double phi = kPi * (i + 0.5) / points, cosTheta = std::cos(theta.x);
        const double radius = kSpotDistance * std::tan(theta.x);
        const double area = radius * kSpotDistance / (cosTheta * cosTheta) * theta.weight * kPi / points;
        const double irradiance =
            kSpotIntensity * falloff(theta.x) * std::pow(cosTheta, 3) / (kSpotDistance * kSpotDistance);
        pieces.push_back({kWallY + radius * std::sin(phi), radius * std::cos(phi),
                          kWallReflectance / kPi * irradiance * area});
      }
  };
  addRing(0, kBeam, [](double) { return 1.0; });
  addRing(kBeam, kCutoff, [](double theta) { return (kCutoff - theta) / (kCutoff - kBeam); });
}

// The irradiance by a point light at the offset (x, y, z), `height` of which is along the normal.
double irradianceByPoint(double intensity, double height, double x, double y, double z) {
  return intensity * height / std::pow(x * x + y * y + z * z, 1.5);
}

void addLamps(std::vector<WallPiece>& pieces, int points) {
  for (const Node& y : gauss(points, kWallY - kWallHalfHeight, kWallY + kWallHalfHeight))
    for (const Node& z : gauss(points, -kWallHalfWidth, kWallHalfWidth)) {
      double irradiance = 0;
      for (const Lamp& lamp : kLamps)
        irradiance +=
            irradianceByPoint(lamp.intensity, kWallX - lamp.x, kWallX - lamp.x, y.x - lamp.y, z.x - lamp.z);
      pieces.push_back({y.x, z.x, kWallReflectance / kPi * irradiance * y.weight * z.weight});
    }
}

std::string integer(const std::string& name, int value) {
  return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
}

std::string film(int size, bool crop) {
  const int full = crop ? 2 * size : size;
  std::string text =
      "<film type=\"hdrfilm\"><rfilter type=\"box\"/>" + integer("width", full) + integer("height", full);
  if (crop)
    text += integer("crop_width", size) + integer("crop_height", size) + integer("crop_offset_x", size / 2) +
            integer("crop_offset_y", size / 2);
  return text + "</film>";
}

}  // namespace

double RarePatch::mean(int points) const {
  std::vector<WallPiece> pieces;
  addSpot(pieces, points);
  if (lamps) addLamps(pieces, points);
  const double halfSide = kCameraHeight * std::tan(kFov / 2) * (crop ? 0.5 : 1);
  const std::vector<Node> floor = gauss(points, -halfSide, halfSide);
  double sum = 0;
  for (const Node& x : floor)
    for (const Node& z : floor) {
      double irradiance = 0;
      for (const WallPiece& piece : pieces) {
        const double dx = kWallX - x.x, dz = piece.z - z.x;
        const double squared = dx * dx + piece.y * piece.y + dz * dz;
        irradiance += piece.intensity * dx * piece.y / (squared * squared);  // two cosines, each over |x − y|
      }
      if (lamps)
        for (const Lamp& lamp : kLamps)
          irradiance += irradianceByPoint(lamp.intensity, lamp.y, lamp.x - x.x, lamp.y, lamp.z - z.x);
      sum += irradiance * x.weight * z.weight;
    }
  return kFloorReflectance / kPi * sum / (4 * halfSide * halfSide);
}

std::string RarePatch::text() const {
  return R"(<sensor type="perspective"><float name="fov" value="8"/><transform name="to_world">
      <lookat origin="0,4,0" target="0,0,0" up="0,0,1"/></transform>)" +
         film(size, crop) + R"(</sensor>
    <shape type="rectangle">
      <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="-90"/></transform>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf>
    </shape>
    <shape type="rectangle">
      <transform name="to_world">
        <scale x="0.6" y="0.4"/><rotate y="1" angle="-90"/><translate x="1" y="0.6"/>
      </transform>
      <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.9"/></bsdf></bsdf>
    </shape>
    <emitter type="spot">
      <transform name="to_world"><lookat origin="-3,0.6,0" target="1,0.6,0" up="0,1,0"/></transform>
      <rgb name="intensity" value="400"/><float name="cutoff_angle" value="2.5"/>
    </emitter>)" +
         (lamps ? R"(<emitter type="point">
      <point name="position" x="-0.3" y="1" z="0.4"/><rgb name="intensity" value="0.003"/>
    </emitter>
    <emitter type="point">
      <point name="position" x="0.5" y="0.5" z="-0.3"/><rgb name="intensity" value="0.001"/>
    </emitter>)"
                : "");
}

}  // namespace odis::test
