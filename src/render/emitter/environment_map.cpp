// envmap: light from infinitely far away, given by an equirectangular image.
//
//   filename   string      HDR, EXR or an 8-bit image
//   scale      number      multiplies the radiance; default 1
//   to_world   transform   turns the image; default identity: the top of the image is +Y, its middle -Z
//                          seen from inside
//   gamma      number      of 8-bit images: 1 means linear, -1 sRGB; default sRGB
//
// Along with Mitsuba 3, a direction d of the image's own space has u = atan2(d.x, -d.z) / 2 pi and v =
// acos(d.y) / pi. Columns are centred within pixels and wrap around; rows are spread from pole to pole, the
// first lies on the upper one. Between the pixels the radiance is bilinear.
//
// A table drives the sampling: a cell is a patch between four pixel centres, weighed by the patch's solid
// angle and by how much the mean luminance of the four exceeds that of the whole map. What is no brighter is
// left to the directions that the surface samples (Karlik et al. 2019, "MIS Compensation"), so the density is
// zero there; a map that is everywhere about as bright is weighed by its luminance alone. Within a cell the
// density is uniform in uv. Against luminance alone, at 16 samples per pixel, the variance of path tracing is
// times 0.82 in japanese-bridge-garden, 0.87 in dining-room, 0.89 in lamborghini, 0.96 in kitchen-ppg and
// 0.98 in teapot-full (docs/lights.md).
#include "render/emitter/environment_map.h"

#include <odis/instruction_sets.h>

#include <array>
#include <numeric>

#include "render/emitter/factories.h"
#include "render/image/image.h"
#include "render/math/angles.h"

namespace odis::render {

namespace {

// No lit patch weighs less than this share of the mean of its row, nor a row less than this share of the mean
// row, so that rounding in the table cannot make them vanish beside a sun.
constexpr float kFloor = 1e-3f;
// If no more than this share of the light exceeds the mean, the map is taken for constant.
constexpr double kConstant = 0.01;

void liftToFloor(std::span<float> weights) {
  double sum = 0;
  for (float w : weights) sum += w;
  const float floor = float(sum / double(weights.size())) * kFloor;
  for (float& w : weights)
    if (w > 0) w = std::max(w, floor);
}

// What each weight exceeds its share of the mean by.
std::vector<float> compensated(std::vector<float> weights, std::span<const float> solidAngles, size_t width) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<float> rest = weights;
  for (size_t i = 0; i < rest.size(); ++i)
    rest[i] = std::max(0.0f, rest[i] - float(total / (4 * M_PI)) * solidAngles[i / width]);
  return std::accumulate(rest.begin(), rest.end(), 0.0) > kConstant * total ? rest : weights;
}

}  // namespace

EnvironmentMap::EnvironmentMap(std::vector<Rgb> pixels, int width, int height, const Matrix4& toWorld,
                               float horizon)
    : m_width(width),
      m_height(std::max(height, 2)),
      m_horizon(horizon),
      m_pixels(std::move(pixels)),
      m_toWorld(toWorld),
      m_toLocal(toWorld.inverse()),
      m_determinant(std::abs(toWorld.minorOf(3, 3))),
      m_table(patchWeights(), uint32_t(m_width), uint32_t(m_height - 1)) {}

// Also adds up the integral of the radiance.
std::vector<float> EnvironmentMap::patchWeights() {
  const size_t width = size_t(m_width);
  m_pixels.reserve(2 * width);  // a single row reaches from pole to pole
  if (m_pixels.size() == width) m_pixels.insert(m_pixels.end(), m_pixels.begin(), m_pixels.begin() + m_width);
  const int rows = m_height - 1;
  std::vector<float> weights(width * size_t(rows)), solidAngles;
  for (int y = 0; y < rows; ++y) {
    // The integral of the sine over the row, times the width of a patch, is the patch's solid angle.
    const double cosTop = std::cos(M_PI * y / rows), cosBottom = std::cos(M_PI * (y + 1) / rows);
    const float solidAngle = float((cosTop - cosBottom) * 2 * M_PI / m_width);
    solidAngles.push_back(solidAngle);
    if (float(y) >= m_horizon * float(rows)) continue;
    const std::span<float> row(weights.data() + size_t(y) * width, width);
    for (int x = 0; x < m_width; ++x) {
      const int right = x + 1 < m_width ? x + 1 : 0;
      const Rgb mean = (pixel(x, y) + pixel(right, y) + pixel(x, y + 1) + pixel(right, y + 1)) * 0.25f;
      m_integral += mean * solidAngle;
      row[size_t(x)] = luminance(mean) * solidAngle;
    }
  }
  weights = compensated(std::move(weights), solidAngles, width);

  std::vector<float> sums;
  for (int y = 0; y < rows; ++y) {
    const std::span<float> row(weights.data() + size_t(y) * width, width);
    liftToFloor(row);
    sums.push_back(float(std::accumulate(row.begin(), row.end(), 0.0)));
  }
  const std::vector<float> before = sums;
  liftToFloor(sums);
  for (size_t i = 0; i < weights.size(); ++i) {
    const size_t y = i / width;
    if (sums[y] > before[y]) weights[i] *= sums[y] / before[y];
  }
  return weights;
}

inline EnvironmentMap::Place EnvironmentMap::placeOf(const Vec3& wi) const {
  const Vec3 local = transformVector(m_toLocal, wi);
  const float stretch = length(local);
  const Vec3 d = local * (1 / stretch);
  const float sinTheta = std::sqrt(d.x * d.x + d.z * d.z), turns = angleInTurns(d.x, -d.z);
  // The arc tangent keeps its precision at the poles, where the arc cosine of d.y has lost it.
  return {{turns < 0 ? turns + 1 : turns, 2 * angleInTurns(sinTheta, d.y)}, sinTheta, stretch};
}

ODIS_WIDE void EnvironmentMap::findPlacesInLanes(const EnvironmentMap& map, size_t count, const Columns3& wi,
                                                 Places& places) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Place place = map.placeOf(wi[i]);
    places.u[i] = place.uv.x;
    places.v[i] = place.uv.y;
    places.sinTheta[i] = place.sinTheta;
    places.stretch[i] = place.stretch;
  }
}

inline EnvironmentMap::Patch EnvironmentMap::patchAt(const Vec2& uv) const {
  // Directions that are not numbers have some place, too.
  const float s = limited(uv.x * float(m_width) - 0.5f, -0.5f, float(m_width) - 0.5f),
              t = limited(uv.y * float(m_height - 1), 0.0f, float(m_height - 1));
  const int column = int(s) - int(s < 0);  // rounded down
  const int left = column < 0 ? m_width - 1 : column, top = std::min(int(t), m_height - 2);
  return {left, left + 1 < m_width ? left + 1 : 0, top, {s - float(column), t - float(top)}};
}

ODIS_WIDE void EnvironmentMap::findPatchesInLanes(const EnvironmentMap& map, size_t count,
                                                  const ImagePlaces& places, Patches& patches) {
  for (size_t i = 0, end = endOfLanes(count); i < end; ++i) {
    const Patch patch = map.patchAt({places.u[i], places.v[i]});
    patches.left[i] = patch.left;
    patches.right[i] = patch.right;
    patches.top[i] = patch.top;
    patches.withinX[i] = patch.within.x;
    patches.withinY[i] = patch.within.y;
  }
}

void EnvironmentMap::findPatches(size_t count, const ImagePlaces& places, Patches& patches) const {
  findPatchesInLanes(*this, count, places, patches);
  for (size_t i = 0; i < count; ++i) {
    __builtin_prefetch(&pixel(patches.left[i], patches.top[i]));
    __builtin_prefetch(&pixel(patches.left[i], patches.top[i] + 1));
  }
}

Rgb EnvironmentMap::lookUp(const Patch& patch, float v) const {
  if (v > m_horizon) return {0, 0, 0};
  const auto [left, right, top, within] = patch;
  return lerp(within.y, lerp(within.x, pixel(left, top), pixel(right, top)),
              lerp(within.x, pixel(left, top + 1), pixel(right, top + 1)));
}

Rgb EnvironmentMap::radiance(const Vec3& wi) const {
  const Vec2 uv = placeOf(wi).uv;
  return lookUp(patchAt(uv), uv.y);
}

// `places` are those of the table before, and those of the image after.
ODIS_WIDE void EnvironmentMap::findDirections(const EnvironmentMap& map, size_t count, const Column& tablePdf,
                                              ImagePlaces& places, Directions& directions) {
  const size_t end = endOfLanes(count);
  const Matrix4 toWorld = map.m_toWorld;  // a copy: see columns.h
  const float halfColumn = 0.5f / float(map.m_width), determinant = map.m_determinant;
  Column sinThetas;
  for (size_t i = 0; i < end; ++i) {
    // Cell 0 of the table begins at the centre of column 0.
    const float right = places.u[i] + halfColumn, u = right >= 1 ? right - 1 : right;
    places.u[i] = u;
    const auto [sinPhi, cosPhi] = sinCosOfTurns(u);
    const auto [sinTheta, cosTheta] = sinCosOfTurns(0.5f * places.v[i]);
    const Vec3 world = transformVector(toWorld, {sinPhi * sinTheta, cosTheta, -cosPhi * sinTheta});
    const float scale = length(world);
    directions.wi.set(i, world * (1 / scale));
    // The solid angle of an element of uv is 2 pi^2 sin(theta); a transform that is not a rotation stretches
    // it further.
    directions.pdf[i] = tablePdf[i] * (scale * scale * scale) / (2 * kPi * kPi * sinTheta * determinant);
    sinThetas[i] = sinTheta;
  }
  for (size_t i = 0; i < end; ++i) {
    const float pdf = directions.pdf[i];
    directions.pdf[i] = sinThetas[i] > 0 ? pdf : 0.0f;
  }
}

void EnvironmentMap::sampleDirections(std::span<const LightDraw> draws, std::span<EmitterSample> samples,
                                      ImagePlaces& at) const {
  std::array<PiecewiseConstant2D::Row, kLanes> rows;
  for (size_t i = 0; i < draws.size(); ++i) {
    rows[i] = m_table.chooseRow(draws[i].u.y);
    m_table.prefetchRow(rows[i], draws[i].u.x);
  }
  Column tablePdf{};
  for (size_t i = 0; i < draws.size(); ++i) {
    const PiecewiseConstant2D::Sample s = m_table.sampleRow(rows[i], draws[i].u.x);
    at.u[i] = s.x.x;
    at.v[i] = s.x.y;
    tablePdf[i] = s.pdf;
  }
  Directions directions;
  findDirections(*this, draws.size(), tablePdf, at, directions);
  for (size_t i = 0; i < draws.size(); ++i)
    samples[i] = {.wi = directions.wi[i], .distance = kInfinity, .pdf = directions.pdf[i]};
}

void EnvironmentMap::sampleEach(std::span<const LightDraw> draws, std::span<EmitterSample> samples) const {
  ImagePlaces places{};
  sampleDirections(draws, samples, places);
  Patches patches;
  findPatches(draws.size(), places, patches);
  for (size_t i = 0; i < draws.size(); ++i)
    if (samples[i].pdf > 0) samples[i].radiance = lookUp(patches[i], places.v[i]);
}

EmitterSample EnvironmentMap::sample(uint32_t part, const Vec3& ref, const Vec2& u) const {
  const LightDraw draw{part, ref, u};
  EmitterSample result;
  sampleEach({&draw, 1}, {&result, 1});
  return result;
}

Vec2 EnvironmentMap::inTable(const Vec2& uv) const {
  float x = uv.x - 0.5f / float(m_width);
  if (x < 0) x += 1;
  return {std::min(x, kOneMinusEpsilon), std::min(uv.y, kOneMinusEpsilon)};
}

Vec2 EnvironmentMap::invert(const Vec3& wi) const {
  return m_table.invert(inTable(placeOf(wi).uv));
}

float EnvironmentMap::pdfAt(const Place& place) const {
  if (!(place.sinTheta > 0)) return 0;
  return m_table.pdf(inTable(place.uv)) / (2 * kPi * kPi * place.sinTheta) /
         (place.stretch * place.stretch * place.stretch * m_determinant);
}

float EnvironmentMap::pdf(const Vec3& wi) const {
  return pdfAt(placeOf(wi));
}

void EnvironmentMap::findPlaces(std::span<const EnvironmentView> views, Places& places) const {
  Columns3 wi{};
  for (size_t i = 0; i < views.size(); ++i) wi.set(i, views[i].wi);
  findPlacesInLanes(*this, views.size(), wi, places);
  for (size_t i = 0; i < views.size(); ++i)
    if (views[i].asksPdf) m_table.prefetchPdf(inTable(places[i].uv));
}

void EnvironmentMap::findDensities(std::span<EnvironmentView> views, const Places& places) const {
  for (size_t i = 0; i < views.size(); ++i) {
    if (views[i].asksPdf) views[i].pdf = pdfAt(places[i]);
    if (views[i].asksNumbers) views[i].u = m_table.invert(inTable(places[i].uv));
  }
}

void EnvironmentMap::view(std::span<EnvironmentView> views) const {
  Places places;
  findPlaces(views, places);
  Patches patches;
  findPatches(views.size(), places, patches);
  for (size_t i = 0; i < views.size(); ++i) views[i].radiance = lookUp(patches[i], places.v[i]);
  findDensities(views, places);
}

void EnvironmentMap::viewDensities(std::span<EnvironmentView> views) const {
  Places places;
  findPlaces(views, places);
  findDensities(views, places);
}

std::vector<EmitterPtr> makeEnvironmentMap(const Properties& node, Builder& builder) {
  const std::string name = node.string("filename");
  const SourceLocation& at = node.parameters.at("filename").location;
  const float gamma = node.number("gamma", kGammaRange, -1.0f), scale = emissionScale(node, "scale", 1.0f);
  const Matrix4 toWorld = node.transform("to_world");
  if (!std::isnormal(toWorld.minorOf(3, 3)))
    throw SceneError(node.location, "the to_world of an envmap has no inverse");

  const std::shared_ptr<const Image> image = builder.image(builder.resolvePath(name, at), gamma == -1, at);
  std::vector<Rgb> pixels;
  pixels.reserve(size_t(image->width()) * size_t(image->height()));
  bool repaired = false;
  for (int y = 0; y < image->height(); ++y)
    for (int x = 0; x < image->width(); ++x) {
      Rgb value = image->rgb(x, y);
      for (float* channel : {&value.x, &value.y, &value.z}) {
        if (!std::isfinite(*channel) || *channel < 0) {
          *channel = 0;
          repaired = true;
        }
        if (gamma != -1 && gamma != 1) *channel = std::pow(*channel, gamma);
      }
      pixels.push_back(value * scale);
    }
  if (repaired)
    builder.warn(at, "\"" + name + "\" has negative or non-finite pixels; they are taken as black");
  return {std::make_shared<EnvironmentMap>(std::move(pixels), image->width(), image->height(), toWorld)};
}

}  // namespace odis::render
