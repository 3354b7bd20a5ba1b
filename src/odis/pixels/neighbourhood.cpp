#include "odis/pixels/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "odis/maps/texel_directions.h"

namespace odis::core {

namespace {

// A sample's radiance / pdf counts at most this many times the mean of all.
constexpr float kClamp = 20;
// How many samples the next wider neighbourhood is worth in the histogram.
constexpr float kPriorSamples = 32;

// A sample as it is seen from a place.
struct Seen {
  Splat texels;
  float weight, energy, radiance, nearness;
  bool near;
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
// every second column of every second row.
template <class Use>
void forEachAround(const FirstVertices& vertices, const PixelPlace& place, const Use& use) {
  const Window near = around(place, kNearMargin), far = around(place, kFarMargin);
  for (int y = std::max(far.y0, 0); y < std::min(far.y1, vertices.height()); ++y)
    for (int x = std::max(far.x0, 0); x < std::min(far.x1, vertices.width()); ++x) {
      const bool isNear = near.contains(x, y);
      if (!isNear && ((x | y) & 1)) continue;
      const FirstVertex& v = vertices.at(x, y);
      if (v.there) use(v, isNear);
    }
}

// How far the near vertices lie from the place: the median, so that what is behind an edge does not count.
float extentOf(const FirstVertices& vertices, const PixelPlace& place) {
  thread_local std::vector<float> distances;
  distances.clear();
  forEachAround(vertices, place, [&](const FirstVertex& v, bool near) {
    if (near) distances.push_back(length(v.position - place.position));
  });
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

void add(Histogram& histogram, const Splat& texels, float value) {
  for (int i = 0; i < 4; ++i) histogram[size_t(texels.texel[i])] += texels.weight[i] * value;
}

// How much alike two surfaces are: 1 where they lie in one plane.
float likeness(const Float3& offset, const Float3& normal, const Float3& other, float extent) {
  const float cosine = std::max(dot(normal, other), 0.0f);
  const float height = extent > 0 ? dot(offset, normal) / extent : 0;
  return cosine * cosine * cosine * cosine / (1 + 4 * height * height);
}

// The direction from a place to where a vertex's light came from.
Float3 aimed(const FirstVertex& v, const Float3& offset) {
  if (!std::isfinite(v.distance)) return v.wi;
  const Float3 to = offset + v.wi * v.distance;
  const float distance = length(to);
  return distance > 0 ? to / distance : v.wi;
}

// What surfaces there are around a place.
struct NearSurfaces {
  Spread albedo, roughness, heights;  // of near ones; heights above the place's plane over the extent
  Float3 normals;                     // their sum
  float nearWeight = 0, farWeight = 0, nearSeen = 0;
};

// Looks at the vertices around, and takes the samples of those that are like the place.
NearSurfaces gather(const FirstVertices& vertices, const PixelPlace& place, std::vector<Seen>& samples) {
  constexpr float kLeastLikeness = 0.01f;
  NearSurfaces around;
  samples.clear();
  const float extent = extentOf(vertices, place);
  forEachAround(vertices, place, [&](const FirstVertex& v, bool near) {
    const Float3 offset = v.position - place.position;
    const float weight = likeness(offset, place.normal, v.normal, extent);
    if (near) {
      around.albedo.add(v.albedo);
      around.roughness.add(v.roughness);
      around.heights.add(extent > 0 ? std::min(std::abs(dot(offset, place.normal)) / extent, 10.0f) : 0);
      around.normals = around.normals + v.normal;
      around.nearWeight += weight;
    }
    around.farWeight += weight;
    const float energy = v.pdf > 0 ? v.radiance / v.pdf : INFINITY;
    if (!std::isfinite(energy) || weight < kLeastLikeness) return;
    samples.push_back({splat(aimed(v, offset)), weight, energy, v.radiance,
                       extent > 0 ? extent / (extent + v.distance) : 0, near});
    around.nearSeen += near;
  });
  return around;
}

// Sums up samples of a total weight; fireflies count less.
void sumUp(const std::vector<Seen>& samples, float totalWeight, Neighbourhood& result,
           EffectiveCount& nearEffective, EffectiveCount& farEffective) {
  double energy = 0;
  for (const Seen& s : samples) energy += double(s.weight) * s.energy;
  const auto most = float(totalWeight > 0 ? kClamp * energy / totalWeight : 0);
  for (const Seen& s : samples) {
    const float clamped = s.weight * std::min(s.energy, most);
    const float radiance = s.weight * s.radiance * (s.energy > most ? most / s.energy : 1);
    add(result.farEnergy, s.texels, clamped);
    add(result.farCount, s.texels, s.weight);
    add(result.farRadiance, s.texels, radiance);
    add(result.nearness, s.texels, s.weight * s.nearness);
    farEffective.add(clamped);
    if (!s.near) continue;
    add(result.nearEnergy, s.texels, clamped);
    add(result.nearCount, s.texels, s.weight);
    add(result.nearRadiance, s.texels, radiance);
    nearEffective.add(clamped);
  }
  for (size_t t = 0; t < kMapTexels; ++t)
    if (result.farCount[t] > 0) result.nearness[t] /= result.farCount[t];
}

// Most texels of single samples are empty.
void logOf(const Histogram& sums, float scale, Histogram& result) {
  for (size_t t = 0; t < kMapTexels; ++t) result[t] = sums[t] > 0 ? std::log1p(scale * sums[t]) : 0;
}

float sumOf(const Histogram& histogram) {
  float sum = 0;
  for (const float value : histogram) sum += value;
  return sum;
}

}  // namespace

void look(const FirstVertices& vertices, const PixelPlace& place, Neighbourhood& result) {
  result = {};
  thread_local std::vector<Seen> samples;
  const NearSurfaces around = gather(vertices, place, samples);
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

void describe(const Neighbourhood& n, const Float3& normal, std::span<float> maps, std::span<float> scalars) {
  const float nearEnergy = sumOf(n.nearEnergy), farEnergy = sumOf(n.farEnergy);
  const float farCount = sumOf(n.farCount), farRadiance = sumOf(n.farRadiance);
  const float toMean = farRadiance > 0 ? farCount / farRadiance : 0;
  const auto share = [](float sum) { return sum > 0 ? float(kMapTexels) / sum : 0; };
  Histogram channels[kPixelChannels];
  Histogram mean{};
  const auto meanRadiance = [&](const Histogram& radiance, const Histogram& count) -> const Histogram& {
    for (size_t t = 0; t < kMapTexels; ++t) mean[t] = count[t] > 0 ? radiance[t] / count[t] : 0;
    return mean;
  };
  logOf(n.nearEnergy, share(nearEnergy), channels[0]);
  logOf(n.nearCount, 1, channels[1]);
  logOf(meanRadiance(n.nearRadiance, n.nearCount), toMean, channels[2]);
  logOf(n.farEnergy, share(farEnergy), channels[3]);
  logOf(n.farCount, 1, channels[4]);
  logOf(meanRadiance(n.farRadiance, n.farCount), toMean, channels[5]);
  channels[6] = cosinesTo(normal);
  channels[7] = n.nearness;
  float* to = maps.data();
  for (int y = 0; y < kMapSize; ++y)
    for (int x = 0; x < kMapSize; ++x)
      for (const Histogram& channel : channels) *to++ = channel[size_t(texelAt(x, y))];
  std::copy_n(n.scalars, kPixelScalars, scalars.begin());
}

Histogram histogramOf(const Neighbourhood& n) {
  const float nearCount = std::expm1(n.scalars[0]), farCount = std::expm1(n.scalars[1]);
  const float nearShare = nearCount / (nearCount + kPriorSamples);
  const float farShare = (1 - nearShare) * farCount / (farCount + kPriorSamples);
  const auto inverse = [](float sum) { return sum > 0 ? 1 / sum : 0; };
  const float toNear = nearShare * inverse(sumOf(n.nearEnergy)),
              toFar = farShare * inverse(sumOf(n.farEnergy));
  Histogram result;
  for (size_t t = 0; t < kMapTexels; ++t)
    result[t] =
        toNear * n.nearEnergy[t] + toFar * n.farEnergy[t] + (1 - nearShare - farShare) / float(kMapTexels);
  return result;
}

}  // namespace odis::core
