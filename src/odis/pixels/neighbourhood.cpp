#include "odis/pixels/neighbourhood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "odis/instruction_sets.h"
#include "odis/maps/fast_log2.h"
#include "odis/maps/texel_directions.h"

namespace odis::core {

namespace {

// A sample's radiance / pdf counts at most this many times the mean of all.
constexpr float kClamp = 20;
// How many samples the next wider neighbourhood is worth in the histogram.
constexpr float kPriorSamples = 32;

// Some vertices around a place, side by side, and what is found of each.
constexpr int kLanes = 16;
struct Lanes {
  float x[kLanes], y[kLanes], z[kLanes];                       // from the place to the vertex
  float nx[kLanes], ny[kLanes], nz[kLanes];                    // normal
  float wx[kLanes], wy[kLanes], wz[kLanes], distance[kLanes];  // of the sample
  float energy[kLanes], radiance[kLanes];                      // energy: radiance / pdf
  float weight[kLanes];                                        // how much the surface is like the place's
  float column[kLanes], row[kLanes];  // where the light came from, in texels of the octahedral square
  float nearness[kLanes];             // of where it came from, weighted
  bool near[kLanes];

  void set(int i, const FirstVertex& v, const Float3& offset, bool isNear) {
    x[i] = offset.x, y[i] = offset.y, z[i] = offset.z;
    nx[i] = v.normal.x, ny[i] = v.normal.y, nz[i] = v.normal.z;
    wx[i] = v.wi.x, wy[i] = v.wi.y, wz[i] = v.wi.z;
    distance[i] = v.distance;
    energy[i] = v.pdf > 0 ? v.radiance / v.pdf : INFINITY;
    radiance[i] = v.radiance;
    near[i] = isNear;
  }
};

// All vertices around a place.
struct Around {
  size_t count = 0;
  std::vector<Lanes> lanes;

  void add(const FirstVertex& v, const Float3& offset, bool near) {
    if (count == lanes.size() * kLanes) lanes.emplace_back();
    lanes[count / kLanes].set(int(count % kLanes), v, offset, near);
    ++count;
  }
};

// Mean and standard deviation of a number over some samples.
struct Spread {
  float count = 0, sum = 0, squares = 0;
  void add(float x) {
    ++count;
    sum += x;
    squares += x * x;
  }
  float deviation() const {
    if (count < 2) return 0;
    const float mean = sum / count;
    return std::sqrt(std::max(squares / count - mean * mean, 0.0f));
  }
};

// The effective number of samples: many of which one holds all the light are worth one.
struct EffectiveCount {
  double sum = 0, squares = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
  }
  float value() const { return squares > 0 ? float(sum * sum / squares) : 0; }
};

float length(const Float3& v) {
  return std::sqrt(dot(v, v));
}

struct Window {
  int x0, y0, x1, y1;
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

Window around(const PixelPlace& place, int margin) {
  return {place.x - margin, place.y - margin, place.x + place.size + margin, place.y + place.size + margin};
}

// Calls use(vertex, near) for the vertices of a neighbourhood: all that are near, and of the others those in
// every second column of every second row, the tile's own left out.
template <class Use>
void forEachAround(const FirstVertices& vertices, const PixelPlace& place, const Use& use) {
  const Window own = around(place, 0), near = around(place, kNearMargin), far = around(place, kFarMargin);
  for (int y = std::max(far.y0, 0); y < std::min(far.y1, vertices.height()); ++y)
    for (int x = std::max(far.x0, 0); x < std::min(far.x1, vertices.width()); ++x) {
      const bool isNear = near.contains(x, y);
      if (own.contains(x, y) || (!isNear && ((x | y) & 1))) continue;
      const FirstVertex& v = vertices.at(x, y);
      if (v.there) use(v, isNear);
    }
}

// What surfaces there are around a place.
struct NearSurfaces {
  Spread albedo, roughness, heights;  // of near ones; heights above the place's plane over the extent
  Float3 normals;                     // their sum
  float extent = 0;                   // how far they lie from the place
  float nearWeight = 0, farWeight = 0, nearSeen = 0;
};

// Puts down the vertices around a place.
NearSurfaces gather(const FirstVertices& vertices, const PixelPlace& place, Around& around) {
  NearSurfaces surfaces;
  thread_local std::vector<float> squares;  // of distances of near ones
  squares.clear();
  around.count = 0;
  forEachAround(vertices, place, [&](const FirstVertex& v, bool near) {
    const Float3 offset = v.position - place.position;
    around.add(v, offset, near);
    if (!near) return;
    squares.push_back(dot(offset, offset));
    surfaces.albedo.add(v.albedo);
    surfaces.roughness.add(v.roughness);
    surfaces.normals = surfaces.normals + v.normal;
  });
  // The median, so that what is behind an edge does not count.
  if (squares.empty()) return surfaces;
  const auto middle = squares.begin() + std::ptrdiff_t(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  surfaces.extent = std::sqrt(*middle);
  return surfaces;
}

// How much alike the place's surface and those around are: 1 where they lie in one plane.
ODIS_WIDE void weigh(const Float3& normal, float perExtent, Lanes& of) {
  for (int i = 0; i < kLanes; ++i) {
    const float facing = normal.x * of.nx[i] + normal.y * of.ny[i] + normal.z * of.nz[i];
    const float cosine = facing > 0 ? facing : 0, squared = cosine * cosine;
    const float height = (of.x[i] * normal.x + of.y[i] * normal.y + of.z[i] * normal.z) * perExtent;
    of.weight[i] = squared * squared / (1 + 4 * height * height);
  }
}

// A coordinate of the octahedral square in texels; no number that is none.
[[gnu::always_inline]] inline float texels(float coordinate) {
  const float least = -0.5f, most = kMapSize - 0.5f, at = coordinate * kMapSize - 0.5f;
  return at > least ? (at < most ? at : most) : least;
}

// From the place to where the samples' light came from. Without an extent nothing is near.
ODIS_WIDE void aim(float extent, Lanes& of) {
  for (int i = 0; i < kLanes; ++i) {
    const float distance = of.distance[i], wx = of.wx[i], wy = of.wy[i], wz = of.wz[i];
    const float x = of.x[i] + wx * distance, y = of.y[i] + wy * distance, z = of.z[i] + wz * distance;
    const float squared = x * x + y * y + z * z, inverse = 1 / std::sqrt(squared);
    const bool anew = (distance < INFINITY) & (squared > 0);
    const float ax = x * inverse, ay = y * inverse, az = z * inverse;
    const Float2 square = directionToSquare(Float3{anew ? ax : wx, anew ? ay : wy, anew ? az : wz});
    of.column[i] = texels(square.x);
    of.row[i] = texels(square.y);
    const float reach = extent + distance;
    of.nearness[i] = of.weight[i] * (extent / (reach > 0 ? reach : 1));
  }
}

// Sums up what is around, and says which samples count: those of surfaces like the place's.
void choose(const PixelPlace& place, float perExtent, Around& around, NearSurfaces& surfaces) {
  constexpr float kLeastLikeness = 0.01f;
  for (size_t i = 0; i < around.count; ++i) {
    Lanes& of = around.lanes[i / kLanes];
    const size_t lane = i % kLanes;
    const float weight = of.weight[lane];
    const bool counts = std::isfinite(of.energy[lane]) && weight >= kLeastLikeness;
    surfaces.farWeight += weight;
    if (of.near[lane]) {
      const Float3 offset{of.x[lane], of.y[lane], of.z[lane]};
      surfaces.heights.add(std::min(std::abs(dot(offset, place.normal)) * perExtent, 10.0f));
      surfaces.nearWeight += weight;
      surfaces.nearSeen += float(counts);
    }
    if (!counts) of.weight[lane] = 0;
  }
}

// Spreads the numbers of a sample bilinearly over the four texels around (column, row).
[[gnu::always_inline]] inline void splatNumbers(float column, float row, const float* numbers,
                                                Neighbourhood& result) {
  const float left = std::floor(column), above = std::floor(row);
  const float fx = column - left, fy = row - above;
  const int x = int(left), y = int(above);
  const float weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  for (int i = 0; i < 4; ++i) {
    int tx = x + i % 2, ty = y + i / 2;
    wrapTexel(tx, ty);
    float* texel = result.sums[ty * kMapSize + tx];
    for (int c = 0; c < kPixelChannels; ++c) texel[c] += weights[i] * numbers[c];
  }
}

// Sums up the samples that count; fireflies count less.
ODIS_WIDE void sumUp(const Around& samples, float totalWeight, Neighbourhood& result,
                     EffectiveCount& nearEffective, EffectiveCount& farEffective) {
  double energy = 0;
  for (size_t i = 0; i < samples.count; ++i) {
    const Lanes& of = samples.lanes[i / kLanes];
    const size_t lane = i % kLanes;
    if (of.weight[lane] > 0) energy += double(of.weight[lane]) * of.energy[lane];
  }
  const auto most = float(totalWeight > 0 ? kClamp * energy / totalWeight : 0);
  for (size_t i = 0; i < samples.count; ++i) {
    const Lanes& of = samples.lanes[i / kLanes];
    const size_t lane = i % kLanes;
    const float weight = of.weight[lane];
    if (!(weight > 0)) continue;
    const float clamped = weight * std::min(of.energy[lane], most);
    const float radiance = weight * of.radiance[lane] * (of.energy[lane] > most ? most / of.energy[lane] : 1);
    const float near = of.near[lane] ? 1 : 0;
    const float numbers[kPixelChannels] = {
        near * clamped, near * weight, near * radiance, clamped, weight, radiance, 0, of.nearness[lane]};
    splatNumbers(of.column[lane], of.row[lane], numbers, result);
    farEffective.add(clamped);
    if (of.near[lane]) nearEffective.add(clamped);
  }
}

// Sums of each channel.
ODIS_WIDE std::array<float, kPixelChannels> sumsOf(const Neighbourhood& n) {
  std::array<float, kPixelChannels> sums{};
  for (const auto& texel : n.sums)
    for (size_t c = 0; c < kPixelChannels; ++c) sums[c] += texel[c];
  return sums;
}

float inverse(float x) {
  return x > 0 ? 1 / x : 0;
}

}  // namespace

void look(const FirstVertices& vertices, const PixelPlace& place, Neighbourhood& result) {
  result = {};
  thread_local Around samples;
  NearSurfaces around = gather(vertices, place, samples);
  const float perExtent = inverse(around.extent);
  for (size_t first = 0; first < samples.count; first += kLanes) {
    weigh(place.normal, perExtent, samples.lanes[first / kLanes]);
    aim(around.extent, samples.lanes[first / kLanes]);
  }
  choose(place, perExtent, samples, around);
  EffectiveCount nearEffective, farEffective;
  sumUp(samples, around.farWeight, result, nearEffective, farEffective);
  const float count = std::max(around.heights.count, 1.0f);
  const float scalars[kPixelScalars] = {std::log1p(nearEffective.value()),
                                        std::log1p(farEffective.value()),
                                        std::log1p(around.nearWeight),
                                        std::log1p(around.farWeight),
                                        place.roughness,
                                        place.albedo,
                                        1 - length(around.normals) / count,
                                        around.nearWeight / count,
                                        around.heights.sum / count,
                                        around.albedo.deviation(),
                                        around.roughness.deviation(),
                                        around.nearSeen / count};
  std::copy_n(scalars, kPixelScalars, result.scalars);
}

ODIS_WIDE void describe(const Neighbourhood& n, const Float3& normal, std::span<float> maps,
                        std::span<float> scalars) {
  const std::array<float, kPixelChannels> sums = sumsOf(n);
  // What makes an energy a multiple of that of an even map, and a radiance one of the mean.
  const float nearShare = kMapTexels * inverse(sums[kNearEnergy]),
              farShare = kMapTexels * inverse(sums[kFarEnergy]),
              toMean = sums[kFarCount] * inverse(sums[kFarRadiance]);
  const Histogram cosines = cosinesTo(normal);
  constexpr float kMost = 1e30f, kLn2 = 0.6931472f;
  float* to = maps.data();
  for (int t = 0; t < kMapTexels; ++t, to += kPixelChannels) {
    const float* of = n.sums[t];
    const float perNear = of[kNearCount] > 0 ? toMean / of[kNearCount] : 0,
                perFar = of[kFarCount] > 0 ? toMean / of[kFarCount] : 0;
    const float factors[kPixelChannels] = {nearShare, 1, perNear, farShare, 1, perFar, 0, 0};
    for (int c = 0; c < kPixelChannels; ++c) {
      const float x = of[c] * factors[c];
      to[c] = kLn2 * fastLog2(1 + (x < kMost ? x : kMost));  // ln(1 + x)
    }
    to[kCosine] = cosines[size_t(texelAt(t % kMapSize, t / kMapSize))];
    to[kNearness] = of[kFarCount] > 0 ? of[kNearness] / of[kFarCount] : 0;
  }
  std::copy_n(n.scalars, kPixelScalars, scalars.begin());
}

Histogram histogramOf(const Neighbourhood& n) {
  const std::array<float, kPixelChannels> sums = sumsOf(n);
  const float nearCount = std::expm1(n.scalars[0]), farCount = std::expm1(n.scalars[1]);
  const float nearShare = nearCount / (nearCount + kPriorSamples);
  const float farShare = (1 - nearShare) * farCount / (farCount + kPriorSamples);
  const float toNear = nearShare * inverse(sums[kNearEnergy]), toFar = farShare * inverse(sums[kFarEnergy]);
  Histogram result;
  for (int t = 0; t < kMapTexels; ++t)
    result[size_t(texelAt(t % kMapSize, t / kMapSize))] = toNear * n.sums[t][kNearEnergy] +
                                                          toFar * n.sums[t][kFarEnergy] +
                                                          (1 - nearShare - farShare) / float(kMapTexels);
  return result;
}

}  // namespace odis::core
