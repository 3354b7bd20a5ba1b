#include "learn/inspect/vertex_integral.h"

#include <cmath>

#include "odis/maps/texel_directions.h"
#include "odis/mixture.h"
#include "odis/models/second_moments.h"
#include "render/path/features.h"

namespace odis::learn {

namespace {

constexpr int kEach = 4;  // directions a side of a texel of targets
constexpr int kGridSide = kEach * kTargetSize;
constexpr int kDirections = kGridSide * kGridSide;
constexpr double kSphere = 4 * M_PI;

// Radiance from a direction as MIS weights it where it has this density.
double weighted(const Converged::Texel& from, float pdf) {
  const float weight = from.lightPdf > 0 ? powerHeuristic(pdf, float(from.lightPdf)) : 1;
  return from.indirect + weight * from.emission;
}

// Over its mean; what is not known counts as nothing.
void normalize(SquareMap& map) {
  double sum = 0;
  for (const float value : map.values)
    if (std::isfinite(value)) sum += value;
  if (!(sum > 0)) return;
  const double scale = double(map.values.size()) / sum;
  for (float& value : map.values) value = float(value * scale);
}

}  // namespace

VertexIntegral::VertexIntegral(const Start& start, const Converged& arriving)
    : m_normal(render::toOdis(start.reference.n)), m_bothSides(start.reference.both) {
  const render::Bsdf& bsdf = start.at.shape->bsdf();
  m_guidable = bsdf.guidableProbability(start.at, start.wo);
  for (size_t t = 0; t < kTargetTexels; ++t) m_arriving.push_back(arriving.texel(t));
  m_directions.resize(kDirections);
  for (int i = 0; i < kDirections; ++i) {
    const int x = i % kGridSide, y = i / kGridSide;
    constexpr int kOfMap = kGridSide / kMapSize;
    Direction& d = m_directions[size_t(i)];
    d.texel = texelAt(x / kOfMap, y / kOfMap);
    d.target = y / kEach * kTargetSize + x / kEach;
    if (!bsdf.traits().evaluable) continue;
    const Float3 wi = squareToDirection(Float2{(float(x) + 0.5f) / kGridSide, (float(y) + 0.5f) / kGridSide});
    const render::BsdfValue value =
        bsdf.evaluate(start.at, start.wo, start.at.shading.toLocal(render::fromOdis(wi)));
    d.value = render::luminance(value.value);
    d.pdf = value.pdf;
    d.guidablePdf = value.guidablePdf;
  }
}

core::PackedMap VertexIntegral::mapOf(const core::Histogram& radiance, float floor) const {
  return core::PackedMap(core::product(radiance, floor, core::meanCosines(m_normal, m_bothSides)));
}

// With f the BSDF times the cosine, q the mixture's density and l that of next-event estimation, indirect
// radiance I and emission E that arrive, and w = q^2 / (q^2 + l^2): the direction's estimate is D = f (I +
// w E) / q, next-event estimation's N = f (1 - w) E / l. Given the vertex they are independent: E[(D +
// N)^2] = E[D^2] + 2 E[D] E[N] + E[N^2].
float VertexIntegral::moment(const SamplingMap<float>& map, float bsdfFraction) const {
  std::array<float, kMapTexels> mapPdf;
  for (int t = 0; t < kMapTexels; ++t) mapPdf[size_t(t)] = map.texelPdf(t);
  double direction = 0, directionSquares = 0, light = 0, lightSquares = 0;
  for (const Direction& d : m_directions) {
    if (!(d.value > 0)) continue;
    const double q = mixturePdf(d.pdf, d.guidablePdf, m_guidable, bsdfFraction, mapPdf[size_t(d.texel)]);
    if (!(q > 0)) continue;
    const Converged::Texel& from = m_arriving[size_t(d.target)];
    const double l = from.lightPdf, ofDirection = q * q / (q * q + l * l);
    const double f = d.value;
    direction += f * (from.indirect + ofDirection * from.emission);
    directionSquares += f * f / q *
                        (from.indirectSquares + 2 * ofDirection * from.indirect * from.emission +
                         ofDirection * ofDirection * from.emissionSquares);
    if (!(l > 0)) continue;
    light += f * (1 - ofDirection) * from.emission;
    lightSquares += f * f * (1 - ofDirection) * (1 - ofDirection) * from.emissionSquares / l;
  }
  constexpr double kSolidAngle = kSphere / kDirections;
  for (double* sum : {&direction, &directionSquares, &light, &lightSquares}) *sum *= kSolidAngle;
  const double mean = direction + light;
  return mean > 0 ? float((directionSquares + 2 * direction * light + lightSquares) / (mean * mean))
                  : kUnknown;
}

Judgement VertexIntegral::judge(const SamplingMap<float>& map, const SamplingMap<float>& converged,
                                float bsdfFraction) const {
  Judgement result;
  result.entropy = render::entropy(map);
  result.divergence = divergence(map, converged);
  result.moment = moment(map, bsdfFraction);
  for (const float candidate : core::kBsdfFractions) {
    const float moment = this->moment(map, candidate);
    if (std::isnan(moment) || result.bestMoment <= moment) continue;
    result.bestMoment = moment;
    result.bestBsdfFraction = candidate;
  }
  return result;
}

template <class Function>
SquareMap VertexIntegral::means(const Function& function) const {
  SquareMap result{kTargetSize, std::vector<float>(kTargetTexels, 0.0f)};
  for (const Direction& d : m_directions)
    result.values[size_t(d.target)] +=
        float(function(d, m_arriving[size_t(d.target)]) / double(kEach * kEach));
  normalize(result);
  return result;
}

SquareMap VertexIntegral::radiance() const {
  return means([](const Direction& d, const Converged::Texel& from) {
    return from.samples > 0 ? weighted(from, d.pdf) : double(kUnknown);
  });
}
core::Histogram VertexIntegral::texels() const {
  core::Histogram result{};
  for (const Direction& d : m_directions)
    result[size_t(d.texel)] += float(weighted(m_arriving[size_t(d.target)], d.pdf));
  return result;
}
SquareMap VertexIntegral::bsdf() const {
  return means([](const Direction& d, const Converged::Texel&) { return d.value; });
}
SquareMap VertexIntegral::best() const {
  return means(
      [](const Direction& d, const Converged::Texel& from) { return d.value * weighted(from, d.pdf); });
}
SquareMap VertexIntegral::mixture(const SamplingMap<float>& map, float bsdfFraction) const {
  return means([&](const Direction& d, const Converged::Texel&) {
    return mixturePdf(d.pdf, d.guidablePdf, m_guidable, bsdfFraction, map.texelPdf(d.texel));
  });
}

SquareMap squareOf(const core::Histogram& texels) {
  SquareMap result{kMapSize, {}};
  for (int y = 0; y < kMapSize; ++y)
    for (int x = 0; x < kMapSize; ++x) result.values.push_back(texels[size_t(texelAt(x, y))]);
  normalize(result);
  return result;
}

SquareMap squareOf(const SamplingMap<float>& map) {
  return squareOf(core::probabilitiesOf(map));
}

float entropyOf(const core::Histogram& weights) {
  double sum = 0, logs = 0;
  for (const float w : weights) {
    if (!(w > 0)) continue;
    sum += w;
    logs += w * std::log2(double(w));
  }
  return sum > 0 ? float(std::log2(sum) - logs / sum) : 0;
}

float divergence(const SamplingMap<float>& map, const SamplingMap<float>& other) {
  double sum = 0;
  for (int t = 0; t < kMapTexels; ++t) {
    const double p = other.texelPdf(t), q = map.texelPdf(t);
    if (p > 0 && q > 0) sum += p * std::log2(p / q);
  }
  return float(sum * kSphere / kMapTexels);
}

}  // namespace odis::learn
