#include "learn/scenes/cameras.h"

#include <algorithm>

#include "learn/scenes/write_scene.h"
#include "render/integrators/render.h"
#include "render/sensor/perspective.h"

namespace odis::learn {

using render::Ray;
using render::SurfacePoint;

namespace {

constexpr int kAttempts = 400;
// Of the brightness of a scene's two views.
constexpr double kMostContrast = 8;
// The share of an image's blocks that some hundred paths each must find light in, relative to the mean so
// much; and of its pixels that one of a few paths must.
constexpr double kLeastLit = 0.7, kLeastLight = 0.03, kLeastPixels = 0.5;

std::shared_ptr<const render::Sensor> sensorOf(const View& view, const Vec2i& resolution) {
  const Vec3 forward = render::normalize(view.target - view.origin);
  const Vec3 left = render::normalize(render::cross({0, 0, 1}, forward)), up = render::cross(forward, left);
  const Matrix4 toWorld(left.x, left.y, left.z, 0, up.x, up.y, up.z, 0, forward.x, forward.y, forward.z, 0,
                        view.origin.x, view.origin.y, view.origin.z, 1);
  const double tangent = std::tan(view.fov * M_PI / 360) * std::min(1.0, double(resolution.x) / resolution.y);
  return std::make_shared<render::Perspective>(toWorld,
                                               render::Projection(2 * std::atan(tangent), resolution));
}

// What a coarse grid of camera rays meets.
struct Look {
  float near = 0, close = 0,
        middle = 0;    // the distance of the nearest 5 %, 25 % and 50 % of the rays, in metres
  float open = 0;      // the share that meets nothing
  float flattest = 0;  // the largest share that meets one plane
  int planes = 0;      // how many different ones, in a coarse count
};

Look lookAt(const render::Scene& scene, const View& view, float scale) {
  constexpr int kColumns = 16, kRows = 9;
  const auto sensor = sensorOf(view, {kColumns, kRows});
  std::vector<float> distances;
  std::vector<std::pair<Vec3, float>> planes;
  int open = 0;
  std::vector<int> counts;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const Ray ray = sensor->ray({float(x) + 0.5f, float(y) + 0.5f}, {0.5f, 0.5f});
      SurfacePoint at;
      if (!scene.intersect(ray, at)) {
        ++open;
        distances.push_back(render::kInfinity);
        continue;
      }
      distances.push_back(render::length(at.p - ray.origin) / scale);
      const float offset = render::dot(at.ng, at.p) / scale;
      const auto same = std::find_if(planes.begin(), planes.end(), [&](const auto& plane) {
        return render::absDot(plane.first, at.ng) > 0.999f &&
               std::abs(std::abs(plane.second) - std::abs(offset)) < 0.02f;
      });
      if (same == planes.end()) {
        planes.emplace_back(at.ng, offset);
        counts.push_back(1);
      } else {
        ++counts[size_t(same - planes.begin())];
      }
    }
  std::sort(distances.begin(), distances.end());
  Look look;
  look.near = distances[distances.size() / 20];
  look.close = distances[distances.size() / 4];
  look.middle = distances[distances.size() / 2];
  look.open = float(open) / (kColumns * kRows);
  look.planes = int(planes.size());
  for (const int count : counts) look.flattest = std::max(look.flattest, float(count) / (kColumns * kRows));
  return look;
}

// Whether no surface is nearer than `clearance` in any of many directions.
bool isFree(const render::Scene& scene, const Vec3& at, float clearance) {
  constexpr int kDirections = 24;
  for (int i = 0; i < kDirections; ++i) {
    // Spread over the sphere by the golden angle.
    const float z = 1 - (2 * float(i) + 1) / kDirections, phi = 2.399963f * float(i),
                r = std::sqrt(1 - z * z);
    const Vec3 d(r * std::cos(phi), r * std::sin(phi), z);
    if (scene.occluded({at, d, clearance})) return false;
  }
  return true;
}

View candidate(const Description& scene, Random& random, bool closeUp) {
  View view;
  const Space& space = scene.standing[size_t(random.integer(0, int(scene.standing.size()) - 1))];
  const Box box = boxAround(space.polygon, space.bottom, space.top);
  const Vec3 subject = scene.interests.empty() ? (box.min + box.max) * 0.5f
                                               : random.pick(std::span<const Vec3>(scene.interests));
  view.fov = float(random.chance(0.8) ? random.range(55, 85) : random.range(35, 105));
  if (closeUp) {
    const auto distance = float(random.logRange(0.35, 1.2));
    const auto phi = float(random.range(0, 2 * M_PI)), lift = float(random.range(-0.1, 0.7));
    view.origin = subject + Vec3(std::cos(phi), std::sin(phi), lift) * distance;
    view.fov = float(random.range(35, 60));
    view.target = subject;
    return view;
  }
  const double height = random.chance(0.8) ? random.range(1.0, 1.8) : random.range(0.3, 2.4);
  view.origin = {float(random.range(box.min.x, box.max.x)), float(random.range(box.min.y, box.max.y)),
                 std::min(space.bottom + float(height), space.top - 0.3f)};
  if (random.chance(0.6)) {
    view.target = subject;
  } else {
    const auto phi = float(random.range(0, 2 * M_PI));
    view.target = view.origin + Vec3(std::cos(phi), std::sin(phi), float(random.range(-0.35, 0.15)));
  }
  return view;
}

bool inside(const Description& scene, const Vec3& p, float margin) {
  return std::any_of(scene.standing.begin(), scene.standing.end(), [&](const Space& space) {
    return p.z > space.bottom + margin && p.z < space.top - margin &&
           contains(space.polygon, {p.x, p.y}, margin);
  });
}

// How much there is to see, 0 if it is not enough.
float interest(const Description& scene, const render::Scene& loaded, const View& view, bool closeUp) {
  if (!inside(scene, view.origin, std::min(0.2f, scene.closest))) return 0;
  const Vec3 direction = render::normalize(view.target - view.origin);
  if (std::abs(direction.z) > (closeUp ? 0.9f : 0.5f)) return 0;
  const View world = inWorld(scene, view);
  if (!isFree(loaded, world.origin, (closeUp ? 0.12f : scene.closest) * scene.scale)) return 0;
  const Look look = lookAt(loaded, world, scene.scale);
  if (look.near < (closeUp ? 0.15f : scene.closest)) return 0;
  if (look.open > (scene.indoors ? 0.4f : 0.65f)) return 0;
  // Something near by may hide a part of the room, not most of it.
  if (look.close < (closeUp ? 0.2f : 1.1f) || look.middle < (closeUp ? 0.3f : 1.6f)) return 0;
  if (look.flattest > (closeUp ? 0.7f : scene.indoors ? 0.5f : 0.6f)) return 0;
  if (look.planes < (closeUp ? 2 : 5)) return 0;
  return std::sqrt(float(look.planes) * std::min(look.middle, 5.0f)) * (1 - look.flattest);
}

// The mean luminance without the brightest tenth of the image, which are lights; 0 if too much of it is
// next to black. Pixels are put together in blocks first, so that noise is not taken for lights.
float brightness(render::Scene& loaded, const View& world) {
  constexpr int kWidth = 40, kBlock = 4;
  render::Progress silent;
  const int blocksX = kWidth / kBlock,
            blocksY = std::max(1, kWidth * world.resolution.y / world.resolution.x / kBlock);
  const Vec2i resolution(blocksX * kBlock, blocksY * kBlock);
  render::FilmSettings film = loaded.film();
  film.width = resolution.x;
  film.height = resolution.y;
  film.crop = {0, 0, resolution.x, resolution.y};
  loaded.setFilm(film);
  loaded.setSensor(sensorOf(world, resolution));
  render::RenderOptions options;
  options.integrator = render::IntegratorKind::path;
  options.spp = 8;
  options.maxDepth = 12;
  const render::RenderResult result = render::render(loaded, options, silent);
  std::vector<double> blocks(size_t(blocksX) * size_t(blocksY));
  int lit = 0;
  for (int y = 0; y < resolution.y; ++y)
    for (int x = 0; x < resolution.x; ++x) {
      const float light = render::luminance(result.image.color[size_t(y) * size_t(resolution.x) + size_t(x)]);
      lit += light > 0;
      blocks[size_t(y / kBlock) * size_t(blocksX) + size_t(x / kBlock)] += light / (kBlock * kBlock);
    }
  if (lit < kLeastPixels * resolution.x * resolution.y) return 0;
  std::sort(blocks.begin(), blocks.end());
  double sum = 0;
  const size_t count = blocks.size() * 9 / 10;
  for (size_t i = 0; i < count; ++i) sum += blocks[i];
  const double dark = blocks[size_t(double(blocks.size()) * (1 - kLeastLit))];
  if (!(dark > kLeastLight * sum / double(count))) return 0;
  return float(sum / double(count));
}

}  // namespace

bool chooseViews(Description& scene, render::Scene& loaded, Random random) {
  scene.views.clear();
  constexpr Vec2i kResolutions[] = {{640, 360}, {640, 360}, {640, 480}, {480, 480}, {360, 640}};
  const Vec2i resolution = random.pick(std::span<const Vec2i>(kResolutions));
  for (const double closeUps : {0.1, 0.2}) {
    const bool closeUp = random.chance(closeUps);
    // The best of a few that will do.
    const int wanted = random.integer(3, 10);
    int found = 0;
    float best = 0;
    View chosen;
    for (int attempt = 0; attempt < kAttempts && found < wanted; ++attempt) {
      // After many attempts a close-up gives way to an ordinary view.
      const bool near = closeUp && attempt < kAttempts / 2;
      View view = candidate(scene, random, near);
      view.resolution = resolution;
      const float value = interest(scene, loaded, view, near);
      found += value > 0;
      if (value <= best) continue;
      best = value;
      chosen = view;
    }
    if (found == 0) return false;
    scene.views.push_back(chosen);
  }
  return true;
}

bool expose(Description& scene, render::Scene& loaded, float target) {
  double product = 1, least = render::kInfinity, most = 0;
  for (const View& view : scene.views) {
    const double value = brightness(loaded, inWorld(scene, view));
    if (!(value > 0) || !std::isfinite(value)) return false;
    product *= value;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  // One exposure has to do for both.
  if (most > kMostContrast * least) return false;
  // Steps of a quarter of a stop: differences of rounding between machines vanish in them.
  const double stops = std::log2(target / std::sqrt(product));
  scene.exposure = float(std::exp2(std::round(4 * stops) / 4));
  return true;
}

}  // namespace odis::learn
