#include "render/scene/intersector.h"

#include <fmt/format.h>

#include <map>
#include <new>
#include <stdexcept>

#include "render/math/columns.h"
#include "render/shape/embree.h"

namespace odis::render {

namespace {

bool countBytes(void* counter, ssize_t bytes, bool) {
  static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

[[noreturn]] void fail(const char* what, RTCError error) {
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(fmt::format("Embree cannot {} (error {})", what, int(error)));
}

RTCRay embreeRay(const Ray& ray) {
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = ray.tMax;
  result.time = ray.time;
  result.mask = ~0u;
  return result;
}

// Packets of 16 rays take a tenth more of a render's time, single rays and packets of 4 a few percent
// (docs/experiments/0032-tracing-side-by-side.md).
constexpr size_t kPacket = 8;
// On some processors (Xeons of the Skylake and Cascade Lake families) Embree's default is trees of four
// children, for the sake of the clock. Those of eight, the default on others, are faster there, too.
constexpr const char* kDeviceConfig = "frequency_level=simd256";

// Embree takes no rays that are not numbers, nor any beyond this (its FLT_LARGE): Debian's builds abort.
constexpr float kMostCoordinate = 1.844e18f;

bool isTraceable(const RTCRay& ray) {
  bool result = !std::isnan(ray.tfar);
  for (const float x : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z})
    result &= std::abs(x) <= kMostCoordinate;
  return result;
}

// Rays that Embree does not take meet nothing: they become others, which are not valid.
void dropUntraceable(RTCRay8& packet, int* valid) {
  // Coordinates whose sum is in range are in range, each of them.
  float sums[kPacket];
  for (size_t i = 0; i < kPacket; ++i)
    sums[i] = std::abs(packet.org_x[i]) + std::abs(packet.org_y[i]) + std::abs(packet.org_z[i]) +
              std::abs(packet.dir_x[i]) + std::abs(packet.dir_y[i]) + std::abs(packet.dir_z[i]);
  int all = 1;
  for (size_t i = 0; i < kPacket; ++i) all &= (sums[i] <= kMostCoordinate) & !std::isnan(packet.tfar[i]);
  if (all) return;
  int usable[kPacket];
  for (size_t i = 0; i < kPacket; ++i) usable[i] = !std::isnan(packet.tfar[i]);
  for (const float* x : {packet.org_x, packet.org_y, packet.org_z, packet.dir_x, packet.dir_y, packet.dir_z})
    for (size_t i = 0; i < kPacket; ++i) usable[i] &= std::abs(x[i]) <= kMostCoordinate;
  for (size_t i = 0; i < kPacket; ++i) {
    if (usable[i]) continue;
    valid[i] = 0;
    for (float* x : {packet.org_x, packet.org_y, packet.org_z, packet.dir_x, packet.dir_y, packet.tfar})
      x[i] = 0;
    packet.dir_z[i] = 1;
  }
}

// Puts the first rays into a packet and says how many they are. Places that are left over repeat the last
// ray: some builds of Embree look at them though they are not valid.
size_t fillPacket(RTCRay8& packet, int* valid, std::span<const Ray> rays) {
  static_assert(sizeof(Ray) == 8 * sizeof(float));  // two rows of four numbers
  const size_t count = std::min(rays.size(), kPacket);
  const Ray* first = rays.data();
  Ray padded[kPacket];
  if (count < kPacket) {
    for (size_t i = 0; i < kPacket; ++i) padded[i] = rays[std::min(i, count - 1)];
    first = padded;
  }
  const auto row = [&](size_t number) { return [=](size_t i) { return &first[i].origin.x + 4 * number; }; };
  for (size_t lane = 0; lane < kPacket; lane += 4) {
    toColumns(lane, row(0), packet.org_x, packet.org_y, packet.org_z, packet.dir_x);
    toColumns(lane, row(1), packet.dir_y, packet.dir_z, packet.tfar, packet.time);
  }
  for (size_t i = 0; i < kPacket; ++i) {
    valid[i] = i < count ? -1 : 0;
    packet.tnear[i] = 0;
    packet.mask[i] = ~0u;
    packet.flags[i] = 0;
  }
  dropUntraceable(packet, valid);
  return count;
}

RTCGeometry stillInstance(RTCDevice device, RTCScene group, const Matrix4& toWorld) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, group);
  // Imath's rows are Embree's columns.
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, toWorld.getValue());
  return geometry;
}

RTCQuaternionDecomposition embreePose(const Pose& pose) {
  RTCQuaternionDecomposition result;
  rtcInitQuaternionDecomposition(&result);
  const auto& [x, y, z] = pose.stretch;
  rtcQuaternionDecompositionSetScale(&result, x.x, y.y, z.z);
  rtcQuaternionDecompositionSetSkew(&result, y.x, z.x, z.y);
  const auto& [r, v] = pose.rotation;
  rtcQuaternionDecompositionSetQuaternion(&result, r, v.x, v.y, v.z);
  const Vec3& t = pose.translation;
  rtcQuaternionDecompositionSetTranslation(&result, t.x, t.y, t.z);
  return result;
}

RTCGeometry movingInstance(RTCDevice device, RTCScene group, const Motion& motion) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, group);
  rtcSetGeometryTimeStepCount(geometry, unsigned(motion.poses().size()));
  for (unsigned step = 0; step < motion.poses().size(); ++step) {
    const RTCQuaternionDecomposition pose = embreePose(motion.poses()[step]);
    rtcSetGeometryTransformQuaternion(geometry, step, &pose);
  }
  return geometry;
}

// A triangle is large if it is so many times as large as the smallest thing in the scene. Rays leave others
// by some 5 * 2^-24 of their longest edge, 1/500 of that thing's size, as Embree errs so much. Double
// precision has its price: 6 % of the time of path tracing where the ground is met in it
// (docs/experiments/0056-large-grounds.md).
constexpr float kLarge = 5000;

// The least and the greatest factor by which an instance changes lengths along its axes.
struct Scales {
  float least = kInfinity, greatest = 0;

  explicit Scales(const Instance& instance) {
    if (instance.motion)
      for (const Pose& pose : instance.motion->poses()) add(pose.matrix());
    else
      add(instance.toWorld);
  }
  void add(const Matrix4& m) {
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = length(Vec3(m[axis][0], m[axis][1], m[axis][2]));
      least = std::min(least, scale);
      greatest = std::max(greatest, scale);
    }
  }
};

// The size of the smallest thing among the shapes. Lamps as small as points stand on nothing.
float detailOf(const std::vector<ShapePtr>& shapes) {
  float least = kInfinity;
  for (const ShapePtr& shape : shapes)
    if (const float detail = shape->detail(); !shape->emitter() && detail > 0)
      least = std::min(least, detail);
  return least;
}

// The extent from which on triangles are large: in the world, and in the space of each group of shapes.
struct LargeExtents {
  float inWorld;
  std::map<const void*, float> inGroups;

  LargeExtents(const std::vector<ShapePtr>& shapes, const std::vector<Instance>& instances)
      : inWorld(detailOf(shapes)) {
    std::map<const void*, float> details;
    for (const Instance& instance : instances) {
      const auto [detail, isNew] = details.try_emplace(instance.group.get(), 0);
      if (isNew) detail->second = detailOf(*instance.group);
      const Scales scales(instance);
      inWorld = std::min(inWorld, detail->second * scales.least);
      float& greatest = inGroups[instance.group.get()];
      greatest = std::max(greatest, scales.greatest);
    }
    inWorld *= kLarge;
    for (auto& [group, extent] : inGroups) extent = inWorld / extent;
  }
};

}  // namespace

Intersector::Intersector(const std::vector<ShapePtr>& shapes, const std::vector<Instance>& instances,
                         bool watertight)
    : m_watertight(watertight) {
  m_device = rtcNewDevice(kDeviceConfig);
  if (!m_device) fail("start", rtcGetDeviceError(nullptr));
  rtcSetDeviceMemoryMonitorFunction(m_device, countBytes, &m_bytes);

  const LargeExtents large(shapes, instances);
  m_scene = makeScene(shapes, large.inWorld, m_shapes);
  m_shapes.push_back(nullptr);
  std::map<const void*, size_t> groupIndex;
  for (const Instance& instance : instances) {
    const auto [entry, isNew] = groupIndex.try_emplace(instance.group.get(), m_groups.size());
    if (isNew) {
      m_groups.push_back(std::make_unique<ShapeArray>());
      m_groupScenes.push_back(
          makeScene(*instance.group, large.inGroups.at(instance.group.get()), *m_groups.back()));
      rtcCommitScene(m_groupScenes.back());
    }
    const RTCScene group = m_groupScenes[entry->second];
    RTCGeometry geometry = instance.motion ? movingInstance(m_device, group, *instance.motion)
                                           : stillInstance(m_device, group, instance.toWorld);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(m_scene, geometry, unsigned(m_shapes.size() + m_placed.size()));
    rtcReleaseGeometry(geometry);
    const Matrix4 inverse(Imath::M44d(instance.toWorld).inverse());
    m_placed.push_back({{instance.toWorld, inverse}, instance.motion.get(), m_groups[entry->second].get()});
  }
  rtcCommitScene(m_scene);
  if (const RTCError error = rtcGetDeviceError(m_device); error != RTC_ERROR_NONE) {
    release();
    fail("build the scene", error);
  }
}

Intersector::~Intersector() {
  release();
}

void Intersector::release() {
  rtcReleaseScene(m_scene);
  for (RTCScene scene : m_groupScenes) rtcReleaseScene(scene);
  rtcReleaseDevice(m_device);
}

RTCSceneTy* Intersector::makeScene(const std::vector<ShapePtr>& shapes, float largeExtent,
                                   ShapeArray& array) {
  RTCScene scene = rtcNewScene(m_device);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  if (m_watertight) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (const ShapePtr& shape : shapes)
    for (RTCGeometry geometry :
         {shape->makeLargeGeometry(m_device, largeExtent, m_watertight), shape->makeGeometry(m_device)}) {
      if (!geometry) continue;
      rtcAttachGeometryByID(scene, geometry, unsigned(array.size()));
      rtcReleaseGeometry(geometry);
      array.push_back(shape.get());
    }
  return scene;
}

Hit Intersector::intersect(const Ray& ray) const {
  RTCRayHit rayHit;
  rayHit.ray = embreeRay(ray);
  if (!isTraceable(rayHit.ray)) return {};
  rayHit.hit.geomID = rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embreeIntersect(m_scene, rayHit);
  const RTCHit& found = rayHit.hit;
  return resolve(found.geomID, found.instID[0], {rayHit.ray.tfar, found.u, found.v, found.primID, nullptr});
}

Hit Intersector::resolve(unsigned geometry, unsigned instance, const RawHit& raw) const {
  if (instance == RTC_INVALID_GEOMETRY_ID)
    return {m_shapes[std::min(size_t(geometry), m_shapes.size() - 1)], raw};
  const Placed& placed = m_placed[instance - m_shapes.size()];
  Hit hit{(*placed.shapes)[geometry], raw, placed.motion};
  hit.raw.instance = &placed.placement;
  return hit;
}

void Intersector::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
  alignas(64) int valid[kPacket];
  RTCRayHit8 packet;
  for (size_t first = 0; first < rays.size(); first += kPacket) {
    const size_t count = fillPacket(packet.ray, valid, rays.subspan(first));
    for (size_t i = 0; i < kPacket; ++i)
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    embreeIntersect(m_scene, valid, packet);
    for (size_t i = 0; i < count; ++i)
      hits[first + i] = resolve(packet.hit.geomID[i], packet.hit.instID[0][i],
                                {packet.ray.tfar[i], packet.hit.u[i], packet.hit.v[i], packet.hit.primID[i]});
  }
}

void Intersector::occluded(std::span<const Ray> rays, std::span<uint8_t> hidden) const {
  alignas(64) int valid[kPacket];
  RTCRay8 packet;
  for (size_t first = 0; first < rays.size(); first += kPacket) {
    const size_t count = fillPacket(packet, valid, rays.subspan(first));
    embreeOccluded(m_scene, valid, packet);
    for (size_t i = 0; i < count; ++i) hidden[first + i] = packet.tfar[i] < 0;
  }
}

bool Intersector::occluded(const Ray& ray) const {
  RTCRay shadowRay = embreeRay(ray);
  if (!isTraceable(shadowRay)) return false;
  embreeOccluded(m_scene, shadowRay);
  return shadowRay.tfar < 0;
}

bool Intersector::box(Vec3& min, Vec3& max) const {
  RTCBounds bounds;
  rtcGetSceneBounds(m_scene, &bounds);
  min = {bounds.lower_x, bounds.lower_y, bounds.lower_z};
  max = {bounds.upper_x, bounds.upper_y, bounds.upper_z};
  return min.x <= max.x && min.y <= max.y && min.z <= max.z;
}

}  // namespace odis::render
