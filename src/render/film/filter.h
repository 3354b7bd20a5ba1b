// Reconstruction filters. A film that splats evaluates them at all pixels that they reach from a sample. A
// film whose pixels are independent of each other samples them by importance: a sample belongs to one pixel,
// its position is drawn from |filter| and its weight is the sign and scale that keep the estimate unbiased
// (Ernst et al. 2006, "Filter Importance Sampling").
#pragma once

#include <memory>
#include <string>

#include "render/math/columns.h"
#include "render/math/interval.h"

namespace odis::render {

// What `u` in [0, 1)^2 draws.
struct FilterSample {
  Vec2 offset;       // from the pixel's centre, in pixels
  float weight = 1;  // filter / density; its expectation is 1, negative for negative lobes
};

// Those of several numbers.
struct FilterSamples {
  Column x, y;  // offsets
  Column weight;

  void set(size_t lane, const FilterSample& sample) {
    x[lane] = sample.offset.x;
    y[lane] = sample.offset.y;
    weight[lane] = sample.weight;
  }
};

// A part of an axis of a filter, between two places around the pixel's centre: the numbers that draw it, and
// what weights are multiplied by, so that their expectation is 1 over the part.
struct FilterPart {
  float first = 0, width = 1;
  float weight = 1;

  // The number that draws a place in the part; as it is where the part is the whole axis.
  float number(float u) const { return std::min(first + u * width, kOneMinusEpsilon); }
};

// Filters that reach over more pixels than this are not splatted: hundreds of pixels would change with every
// sample.
inline constexpr int kMostSplatReach = 16;

class Filter {
 public:
  virtual ~Filter() = default;
  virtual FilterSample sample(const Vec2& u) const = 0;
  // The same in the first `count` lanes.
  virtual void sampleEach(size_t count, const Column& u, const Column& v, FilterSamples& samples) const {
    for (size_t i = 0; i < count; ++i) samples.set(i, sample({u[i], v[i]}));
  }
  // The normalised filter (its integral is 1) at an offset from the pixel's centre.
  virtual float value(const Vec2& offset) const = 0;
  // One axis of it, not normalised, at the centres of the pixels from reach() before a sample's own pixel to
  // reach() after it: the sample lies at `offset` from its pixel's centre, -0.5 to 0.5. For filters that are
  // splatted: reach() is at most kMostSplatReach.
  virtual void taps(float offset, float* values) const = 0;
  virtual float radius() const = 0;  // in pixels
  virtual std::string name() const = 0;

  // The filter reaches over the border of this many pixels, counted from the border.
  int reach() const { return m_reach; }
  // What lies on a film that has so many pixels before this one and so many after it.
  FilterPart part(int before, int after) const {
    const Side a = side(before), b = side(after);
    const double drawn = a.drawn + b.drawn;
    return {float(0.5 - a.drawn), float(drawn), float(drawn / (a.integral + b.integral))};
  }

 protected:
  // Of a radius that may turn out to be none.
  explicit Filter(float radius) : m_reach(radius > 0 && radius < 1e6f ? int(std::ceil(radius - 0.5f)) : 0) {}

  // From the pixel's centre to the border behind so many pixels, on one axis and to one side; 0.5 each where
  // the border is beyond the radius.
  struct Side {
    double drawn;     // how probable an offset is there
    double integral;  // of the normalised filter
  };
  virtual Side side(int pixels) const = 0;

 private:
  int m_reach;
};

// In pixels: narrower filters have no place in single precision, wider ones blur everything.
inline constexpr NumberRange kFilterRadius = between(0.001, 100);
// The range of b and c: beyond it the filter's lobes cancel each other and only noise is left.
inline constexpr NumberRange kMitchellRange = between(0, 1);

// More lobes are more noise than sharpness.
inline constexpr NumberRange kFilterLobes = between(1, 16);

// Parameters and defaults as in Mitsuba; throw std::invalid_argument. Separable.
std::unique_ptr<Filter> makeBoxFilter(float radius = 0.5f);
std::unique_ptr<Filter> makeTentFilter(float radius = 1.0f);
std::unique_ptr<Filter> makeGaussianFilter(float stddev = 0.5f);  // radius 4 stddev
std::unique_ptr<Filter> makeLanczosFilter(int lobes = 3);         // radius lobes
std::unique_ptr<Filter> makeMitchellFilter(float b = 1.0f / 3.0f, float c = 1.0f / 3.0f);

}  // namespace odis::render
