#include "eval/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace odis::eval {

using render::Rgb;

namespace {

constexpr double kPi = 3.14159265358979323846;

// Exponent of the colour difference, the point where its curve bends, and the width of features in degrees.
constexpr double kColorExponent = 0.7, kBendAt = 0.4, kBendTo = 0.95;
constexpr double kFeatureWidth = 0.082, kFeatureExponent = 0.5;

// ---- Colour spaces. XYZ is relative to the white of D65.

constexpr double kWhiteX = 0.950428545, kWhiteZ = 1.088900371;

Rgb toXyz(const Rgb& c) {
  return {float((0.412386563 * c.x + 0.357591491 * c.y + 0.180450491 * c.z) / kWhiteX),
          float(0.212636822 * c.x + 0.715182982 * c.y + 0.072180196 * c.z),
          float((0.01933062 * c.x + 0.119197164 * c.y + 0.950372587 * c.z) / kWhiteZ)};
}

Rgb fromXyz(const Rgb& relative) {
  const double x = relative.x * kWhiteX, y = relative.y, z = relative.z * kWhiteZ;
  return {float(3.241003275 * x - 1.537398934 * y - 0.498615861 * z),
          float(-0.969224334 * x + 1.875930071 * y + 0.041554224 * z),
          float(0.055639423 * x - 0.204011202 * y + 1.057148933 * z)};
}

// An opponent space like L*a*b*, but linear.
Rgb toYCxCz(const Rgb& c) {
  const Rgb xyz = toXyz(c);
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Rgb fromYCxCz(const Rgb& c) {
  const float y = (c.x + 16) / 116;
  return fromXyz({y + c.y / 500, y, y - c.z / 200});
}

// L*a*b*, its chroma scaled with L*: colours of dark things differ less (Hunt effect).
Rgb toHuntLab(const Rgb& c) {
  constexpr double kDelta = 6.0 / 29;
  const Rgb xyz = toXyz(c);
  double f[3];
  for (int i = 0; i < 3; ++i)
    f[i] = xyz[i] > kDelta * kDelta * kDelta ? std::cbrt(double(xyz[i]))
                                             : xyz[i] / (3 * kDelta * kDelta) + 4.0 / 29;
  const double lightness = 116 * f[1] - 16;
  return {float(lightness), float(0.01 * lightness * 500 * (f[0] - f[1])),
          float(0.01 * lightness * 200 * (f[1] - f[2]))};
}

// Lightness by itself, chroma as a length.
double hyab(const Rgb& a, const Rgb& b) {
  return std::abs(double(a.x) - b.x) + std::hypot(double(a.y) - b.y, double(a.z) - b.z);
}

// ---- Filters, separable; the image's border is repeated outside.

using Plane = std::vector<double>;
using Kernel = std::vector<double>;  // from -radius to radius

struct Size {
  int width, height;
};

Kernel makeKernel(int radius, const std::function<double(int)>& value) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(value(i));
  return kernel;
}

Plane filterRows(const Plane& in, Size size, const Kernel& kernel) {
  Plane out(in.size());
  const int radius = int(kernel.size() / 2);
  for (int y = 0; y < size.height; ++y) {
    const double* row = &in[size_t(y) * size_t(size.width)];
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int i = 0; i <= 2 * radius; ++i)
        sum += kernel[size_t(i)] * row[std::clamp(x + i - radius, 0, size.width - 1)];
      out[size_t(y) * size_t(size.width) + size_t(x)] = sum;
    }
  }
  return out;
}

Plane filterColumns(const Plane& in, Size size, const Kernel& kernel) {
  Plane out(in.size(), 0.0);
  const int radius = int(kernel.size() / 2);
  for (int y = 0; y < size.height; ++y)
    for (int i = 0; i <= 2 * radius; ++i) {
      const double* row = &in[size_t(std::clamp(y + i - radius, 0, size.height - 1)) * size_t(size.width)];
      double* to = &out[size_t(y) * size_t(size.width)];
      for (int x = 0; x < size.width; ++x) to[x] += kernel[size_t(i)] * row[x];
    }
  return out;
}

// ---- What the eye makes of colours.

// The contrast sensitivity of a channel as a sum of two Gaussians a sqrt(pi / b) exp(-(pi x)^2 / b), x in
// degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities{
    {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

Plane blur(const Plane& plane, Size size, const Sensitivity& s) {
  // All channels get the radius of the widest.
  const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * kFlipPixelsPerDegree));
  Plane sum(plane.size(), 0.0);
  double weight = 0;
  for (const auto& [a, b] : {std::pair(s.a1, s.b1), std::pair(s.a2, s.b2)}) {
    if (a == 0) continue;
    const double factor = a * std::sqrt(kPi / b), rate = kPi * kPi / b;
    const Kernel kernel = makeKernel(radius, [&](int i) {
      const double x = i / kFlipPixelsPerDegree;
      return std::exp(-rate * x * x);
    });
    double total = 0;
    for (const double value : kernel) total += value;
    weight += factor * total * total;
    const Plane part = filterColumns(filterRows(plane, size, kernel), size, kernel);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += factor * part[i];
  }
  for (double& value : sum) value /= weight;
  return sum;
}

// What is seen of an image's colours from where its pixels can hardly be told apart.
std::vector<Rgb> seenColors(const ColorImage& image) {
  const Size size{image.width, image.height};
  std::array<Plane, 3> channels;
  for (const Rgb& pixel : image.pixels) {
    const Rgb opponent = toYCxCz(pixel);
    for (int c = 0; c < 3; ++c) channels[size_t(c)].push_back(opponent[c]);
  }
  for (size_t c = 0; c < 3; ++c) channels[c] = blur(channels[c], size, kSensitivities[c]);
  std::vector<Rgb> result;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    Rgb color = fromYCxCz({float(channels[0][i]), float(channels[1][i]), float(channels[2][i])});
    for (int c = 0; c < 3; ++c) color[c] = std::clamp(color[c], 0.0f, 1.0f);
    result.push_back(toHuntLab(color));
  }
  return result;
}

// In [0, 1]: small differences take most of the range.
double colorDifference(const Rgb& a, const Rgb& b) {
  static const double kLargest = std::pow(hyab(toHuntLab({0, 1, 0}), toHuntLab({0, 0, 1})), kColorExponent);
  const double difference = std::pow(hyab(a, b), kColorExponent), bend = kBendAt * kLargest;
  if (difference < bend) return difference * kBendTo / bend;
  return kBendTo + (difference - bend) / (kLargest - bend) * (1 - kBendTo);
}

// ---- Edges and points.

struct Features {
  Plane edges, points;
};

// Scales positive weights to a sum of 1 and negative ones to -1.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double value : kernel) (value > 0 ? positive : negative) += std::abs(value);
  for (double& value : kernel) value /= value > 0 ? positive : negative;
  return kernel;
}

Features featuresOf(const ColorImage& image) {
  const Size size{image.width, image.height};
  Plane grey;
  for (const Rgb& pixel : image.pixels) grey.push_back(toXyz(pixel).y);
  const double deviation = 0.5 * kFeatureWidth * kFlipPixelsPerDegree;
  const int radius = int(std::ceil(3 * deviation));
  const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
  Kernel smooth = makeKernel(radius, gaussian);
  double total = 0;
  for (const double value : smooth) total += value;
  for (double& value : smooth) value /= total;
  const Kernel slope = balanced(makeKernel(radius, [&](int i) { return -i * gaussian(i); }));
  const Kernel bump = balanced(
      makeKernel(radius, [&](int i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); }));

  // The lengths of the first and of the second derivatives along x and y.
  const auto lengths = [&](const Kernel& derivative) {
    Plane x = filterColumns(filterRows(grey, size, derivative), size, smooth);
    const Plane y = filterColumns(filterRows(grey, size, smooth), size, derivative);
    for (size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
    return x;
  };
  return {lengths(slope), lengths(bump)};
}

}  // namespace

std::vector<float> flipMap(const ColorImage& image, const ColorImage& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw std::invalid_argument("the images differ in size");
  if (image.pixels.empty()) throw std::invalid_argument("the images have no pixels");
  const std::vector<Rgb> imageColors = seenColors(image), referenceColors = seenColors(reference);
  const Features a = featuresOf(image), b = featuresOf(reference);
  std::vector<float> result;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    // Where features differ, the same difference of colours is seen the better.
    const double feature = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    const double featureDifference = std::pow(feature / std::sqrt(2.0), kFeatureExponent);
    result.push_back(
        float(std::pow(colorDifference(imageColors[i], referenceColors[i]), 1 - featureDifference)));
  }
  return result;
}

}  // namespace odis::eval
