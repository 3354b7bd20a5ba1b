// What tiny.cpp and tiny_odis.cpp render: rectangles and spheres, and three scenes made of them. Lengths are
// in metres, z points up, colours are linear.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

constexpr float kPi = 3.14159265f, kInfinity = INFINITY;

// A point, a direction or a colour.
struct Vec3 {
  float x = 0, y = 0, z = 0;

  Vec3() = default;
  Vec3(float x, float y, float z) : x(x), y(y), z(z) {}
  // From and to the vectors of other libraries.
  template <class Other, class = decltype(Other::z)>
  Vec3(const Other& v) : x(v.x), y(v.y), z(v.z) {}
  template <class Other, class = decltype(Other::z)>
  operator Other() const {
    return {x, y, z};
  }

  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend Vec3 operator*(const Vec3& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vec3 operator/(const Vec3& a, float s) { return a * (1 / s); }
};
inline float dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3 normalize(const Vec3& v) {
  return v / std::sqrt(dot(v, v));
}
inline float maxComponent(const Vec3& v) {
  return std::max({v.x, v.y, v.z});
}
inline float luminance(const Vec3& color) {
  return dot(color, {0.212671f, 0.715160f, 0.072169f});
}

// An orthonormal basis around a unit vector n (Duff et al. 2017).
struct Frame {
  Vec3 s, t, n;
  explicit Frame(const Vec3& n) : n(n) {
    const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3 toLocal(const Vec3& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3 toWorld(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

struct Material {
  Vec3 color;           // albedo, or the reflectance of metal at normal incidence
  float roughness = 1;  // alpha of GGX; 1: diffuse
  Vec3 emission = {};   // radiance, on the side of the normal
};

struct Ray {
  Vec3 origin, direction;
};

// A rectangle or a sphere; if it emits, next-event estimation samples it.
struct Shape {
  Vec3 origin, u, v;  // corner and edges of a rectangle; the centre of a sphere
  float radius;       // of a sphere; 0: a rectangle
  Material material;
  Vec3 n;      // of the rectangle
  float area;  // of the rectangle

  // The distance along the ray; infinity if it misses.
  float intersect(const Ray& ray) const {
    const Vec3 to = origin - ray.origin;
    if (radius == 0) {
      const float t = dot(to, n) / dot(ray.direction, n);
      const Vec3 p = ray.direction * t - to;
      const float a = dot(p, u), b = dot(p, v);
      return t > 0 && a >= 0 && a <= dot(u, u) && b >= 0 && b <= dot(v, v) ? t : kInfinity;
    }
    const float along = dot(to, ray.direction);
    const Vec3 nearest = ray.direction * along - to;
    const float half2 = radius * radius - dot(nearest, nearest), t = along - std::sqrt(std::max(half2, 0.0f));
    return half2 > 0 && t > 0 ? t : kInfinity;
  }
  Vec3 normal(const Vec3& p) const { return radius == 0 ? n : (p - origin) / radius; }

  // Samples a direction towards the shape, from u1, u2 uniform in [0, 1).
  Vec3 sampleDirection(const Vec3& from, float u1, float u2) const {
    if (radius == 0) return normalize(origin + u * u1 + v * u2 - from);
    const float c = 1 - u1 * coneHeight(from), r = std::sqrt(std::max(1 - c * c, 0.0f)), phi = 2 * kPi * u2;
    return Frame(normalize(origin - from)).toWorld({r * std::cos(phi), r * std::sin(phi), c});
  }
  // The density of that, with respect to solid angle, for a direction that meets the shape at a distance.
  float directionPdf(const Vec3& from, const Vec3& wi, float distance) const {
    if (radius == 0) return distance * distance / (area * std::abs(dot(wi, n)));
    return 1 / (2 * kPi * coneHeight(from));
  }
  // 1 - the cosine of the angle under which the radius is seen.
  float coneHeight(const Vec3& from) const {
    const float sine2 = radius * radius / dot(origin - from, origin - from);
    return sine2 / (1 + std::sqrt(std::max(1 - sine2, 0.0f)));
  }
};

struct Hit {
  const Shape* shape = nullptr;  // null: the ray left the scene
  float distance = kInfinity;
  Vec3 p, n;  // a little off the surface, so that rays may start there; on the side of the ray
  Vec3 color, emission;
  float roughness = 1;
};

struct LightSample {
  Vec3 wi, radiance;
  float distance = 0, pdf = 0;  // pdf: with respect to solid angle, choice of the light included; 0: no light
};

class Scene {
 public:
  // Puts the camera at `eye`; `tangent` is that of half of its horizontal field of view.
  void look(const Vec3& eye, const Vec3& target, float tangent) {
    m_eye = eye;
    m_forward = normalize(target - eye);
    m_right = normalize(cross(m_forward, {0, 0, 1})) * tangent;
    m_up = normalize(cross(m_right, m_forward)) * tangent;
  }
  // The camera ray at x, y in units of half of the image's width, from its middle.
  Ray cameraRay(float x, float y) const { return {m_eye, normalize(m_forward + m_right * x + m_up * y)}; }

  void rectangle(const Vec3& corner, const Vec3& u, const Vec3& v, const Material& material) {
    const Vec3 n = cross(u, v);
    m_shapes.push_back({corner, u, v, 0, material, normalize(n), std::sqrt(dot(n, n))});
  }
  void sphere(const Vec3& center, float radius, const Material& material) {
    m_shapes.push_back({center, {}, {}, radius, material, {}, 0});
  }
  // A box on the floor of its `base` (the middle), turned by `angle` around the vertical.
  void box(const Vec3& base, const Vec3& size, float angle, const Material& material) {
    const Vec3 u = Vec3(std::cos(angle), std::sin(angle), 0) * size.x, up(0, 0, size.z);
    const Vec3 v = Vec3(-std::sin(angle), std::cos(angle), 0) * size.y, corner = base - (u + v) * 0.5f;
    rectangle(corner, u, up, material);
    rectangle(corner + v, u, up, material);
    rectangle(corner, v, up, material);
    rectangle(corner + u, v, up, material);
    rectangle(corner, u, v, material);
    rectangle(corner + up, u, v, material);
  }
  // Gathers the lights. To be called when all shapes are there.
  void finish() {
    for (const Shape& shape : m_shapes)
      if (maxComponent(shape.material.emission) > 0) m_lights.push_back(&shape);
  }

  Hit intersect(const Ray& ray) const {
    Hit hit;
    for (const Shape& shape : m_shapes)
      if (const float t = shape.intersect(ray); t < hit.distance) hit.distance = t, hit.shape = &shape;
    if (!hit.shape) return hit;
    hit.p = ray.origin + ray.direction * hit.distance;
    hit.n = hit.shape->normal(hit.p);
    const Material& material = hit.shape->material;
    hit.color = material.color;
    hit.roughness = material.roughness;
    const bool front = dot(hit.n, ray.direction) < 0;
    if (front) hit.emission = material.emission;
    if (!front) hit.n = hit.n * -1;
    hit.p = hit.p + hit.n * 1e-4f;
    return hit;
  }
  bool isHidden(const Ray& ray, float distance) const {
    return std::any_of(m_shapes.begin(), m_shapes.end(),
                       [&](const Shape& shape) { return shape.intersect(ray) < distance * 0.9999f; });
  }

  size_t lightCount() const { return m_lights.size(); }
  // Samples a direction towards the light of this index, which was chosen with `probability`.
  LightSample sampleLight(size_t index, float probability, const Vec3& from, float u, float v) const {
    const Shape& light = *m_lights[index];
    const Vec3 wi = light.sampleDirection(from, u, v);
    const float distance = light.intersect({from, wi});
    if (distance == kInfinity || dot(wi, light.normal(from + wi * distance)) >= 0) return {};
    return {wi, light.material.emission, distance, light.directionPdf(from, wi, distance) * probability};
  }
  size_t lightIndex(const Shape* shape) const {
    return size_t(std::find(m_lights.begin(), m_lights.end(), shape) - m_lights.begin());
  }

 private:
  Vec3 m_eye, m_forward, m_right, m_up;
  std::vector<Shape> m_shapes;
  std::vector<const Shape*> m_lights;
};

// ---- the three scenes ----

const Vec3 kWhite{0.75f, 0.73f, 0.7f}, kWood{0.45f, 0.28f, 0.15f}, kBlue{0.25f, 0.35f, 0.55f};
const Vec3 kRed{0.6f, 0.16f, 0.12f}, kGreen{0.28f, 0.42f, 0.2f}, kGold{0.95f, 0.7f, 0.35f};

// The room [0, size], without its wall at the greatest y, and with two coloured walls.
inline Scene emptyRoom(const Vec3& size, const Vec3& left, const Vec3& right, const Vec3& floor) {
  Scene scene;
  const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  scene.rectangle({}, x, y, {floor});
  scene.rectangle(z, x, y, {kWhite});
  scene.rectangle({}, x, z, {kWhite});
  scene.rectangle(x, y, z, {right});
  if (left.x > 0) scene.rectangle({}, y, z, {left});
  return scene;
}

// A room that is lit by the lamp of the room next to it, through a door ajar.
inline Scene doorScene() {
  Scene scene = emptyRoom({4, 5, 2.6f}, kGreen, kWhite, kWood);
  scene.look({2.9f, 0.3f, 1.5f}, {1.7f, 5, 0.95f}, 0.72f);
  // The wall with the door, whose hinges are at its right.
  scene.rectangle({0, 5, 0}, {2.2f, 0, 0}, {0, 0, 2.6f}, {kWhite});
  scene.rectangle({3.1f, 5, 0}, {0.9f, 0, 0}, {0, 0, 2.6f}, {kWhite});
  scene.rectangle({2.2f, 5, 2.05f}, {0.9f, 0, 0}, {0, 0, 0.55f}, {kWhite});
  const float angle = 0.7f, x = 0.45f * std::cos(angle), y = 0.45f * std::sin(angle);
  scene.box({3.1f - x, 4.97f - y, 0.01f}, {0.9f, 0.04f, 2.03f}, angle, {kWood});
  // The room behind it.
  scene.rectangle({0, 5.1f, 0}, {4, 0, 0}, {0, 4, 0}, {kWhite});
  scene.rectangle({0, 5.1f, 2.6f}, {4, 0, 0}, {0, 4, 0}, {kWhite});
  scene.rectangle({0, 5.1f, 0}, {0, 4, 0}, {0, 0, 2.6f}, {kWhite});
  scene.rectangle({4, 5.1f, 0}, {0, 4, 0}, {0, 0, 2.6f}, {kWhite});
  scene.rectangle({0, 9.1f, 0}, {4, 0, 0}, {0, 0, 2.6f}, {kWhite});
  scene.rectangle({1.6f, 7, 2.59f}, {0, 0.8f, 0}, {0.8f, 0, 0}, {kWhite, 1, {200, 170, 130}});
  // A sideboard with three balls.
  scene.box({0.7f, 3.2f, 0}, {0.8f, 1.8f, 0.7f}, 0, {kWhite});
  scene.sphere({0.7f, 2.65f, 0.9f}, 0.2f, {kRed});
  scene.sphere({0.7f, 3.2f, 0.9f}, 0.2f, {kGold, 0.2f});
  scene.sphere({0.7f, 3.75f, 0.9f}, 0.2f, {kBlue});
  return scene;
}

// A room that is lit by the bulb of a standard lamp, whose shade is open at both ends.
inline Scene lampScene() {
  Scene scene = emptyRoom({4, 4.5f, 2.6f}, kBlue, kWhite, kWood);
  scene.look({2.2f, 0.3f, 1.4f}, {1.9f, 4.5f, 0.95f}, 0.72f);
  scene.rectangle({0, 4.5f, 0}, {4, 0, 0}, {0, 0, 2.6f}, {kWhite});
  const Vec3 foot{3, 3.4f, 0};
  scene.box(foot, {0.3f, 0.3f, 0.03f}, 0.3f, {kGold, 0.3f});
  scene.box(foot, {0.03f, 0.03f, 1.45f}, 0.3f, {kGold, 0.3f});
  scene.sphere(foot + Vec3{0, 0, 1.53f}, 0.05f, {kWhite, 1, {420, 330, 220}});
  constexpr int kSides = 8;
  for (int i = 0; i < kSides; ++i) {
    const auto corner = [&](int k) {
      return Vec3{0.22f * std::cos(2 * kPi * float(k) / kSides),
                  0.22f * std::sin(2 * kPi * float(k) / kSides), 1.38f};
    };
    scene.rectangle(foot + corner(i), corner(i + 1) - corner(i), {0, 0, 0.32f}, {{0.7f, 0.6f, 0.45f}});
  }
  // A sofa, a table, and what is on it.
  scene.box({1.3f, 3.8f, 0.1f}, {2, 0.8f, 0.35f}, 0, {kRed});
  scene.box({1.3f, 4.2f, 0.1f}, {2, 0.2f, 0.75f}, 0, {kRed});
  scene.box({1.4f, 2.4f, 0.35f}, {1.1f, 0.6f, 0.05f}, 0.2f, {kWood});
  scene.box({1.4f, 2.4f, 0}, {0.5f, 0.3f, 0.35f}, 0.2f, {kWood});
  scene.sphere({1.2f, 2.35f, 0.52f}, 0.12f, {kGold, 0.15f});
  scene.sphere({1.65f, 2.45f, 0.48f}, 0.08f, {kWhite});
  return scene;
}

// A room that is lit by sun and sky through a window at its left.
inline Scene sunScene() {
  Scene scene = emptyRoom({4, 5, 2.6f}, {}, kWhite, kWood);
  scene.look({2.9f, 0.3f, 1.45f}, {1.7f, 5, 1}, 0.72f);
  scene.rectangle({0, 5, 0}, {4, 0, 0}, {0, 0, 2.6f}, {kWhite});
  // The wall with the window.
  scene.rectangle({}, {0, 2.4f, 0}, {0, 0, 2.6f}, {kWhite});
  scene.rectangle({0, 3.8f, 0}, {0, 1.2f, 0}, {0, 0, 2.6f}, {kWhite});
  scene.rectangle({0, 2.4f, 0}, {0, 1.4f, 0}, {0, 0, 0.8f}, {kWhite});
  scene.rectangle({0, 2.4f, 2.1f}, {0, 1.4f, 0}, {0, 0, 0.5f}, {kWhite});
  // Outside: the ground, the sky as a far wall, the sun as a far ball.
  scene.rectangle({-100, -150, -0.5f}, {100, 0, 0}, {0, 300, 0}, {kGreen});
  scene.rectangle({-100, -150, -0.5f}, {0, 300, 0}, {0, 0, 150}, {{}, 1, {1.5f, 2.2f, 3.2f}});
  scene.sphere({-70, 12, 55}, 0.45f, {{}, 1, {200e3f, 180e3f, 150e3f}});
  scene.box({3.3f, 3.9f, 0}, {0.7f, 1.6f, 0.7f}, 0, {kBlue});
  scene.sphere({3.3f, 3.5f, 0.9f}, 0.2f, {kGold, 0.2f});
  scene.sphere({3.3f, 4.2f, 0.85f}, 0.15f, {kRed});
  scene.box({1.2f, 4.2f, 0}, {0.5f, 0.5f, 0.5f}, 0.4f, {kRed});
  return scene;
}

inline Scene makeScene(const std::string& name) {
  Scene scene;
  if (name == "door")
    scene = doorScene();
  else if (name == "lamp")
    scene = lampScene();
  else if (name == "sun")
    scene = sunScene();
  else
    throw std::invalid_argument("no scene '" + name + "': there are door, lamp and sun");
  scene.finish();
  return scene;
}
