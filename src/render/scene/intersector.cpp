#include "render/scene/intersector.h"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "render/shape/embree.h"

namespace odis::render {

namespace {

bool countBytes(void* counter, ssize_t bytes, bool) {
  static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
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
  result.mask = ~0u;
  return result;
}

}  // namespace

Intersector::Intersector(const std::vector<ShapePtr>& shapes, const std::vector<Instance>& instances) {
  m_device = rtcNewDevice(nullptr);
  if (!m_device)
    throw std::runtime_error(fmt::format("Embree cannot start (error {})", int(rtcGetDeviceError(nullptr))));
  rtcSetDeviceMemoryMonitorFunction(m_device, countBytes, &m_bytes);

  m_scene = makeScene(shapes, m_shapes);
  std::map<const void*, size_t> groupIndex;
  for (const Instance& instance : instances) {
    const auto [entry, isNew] = groupIndex.try_emplace(instance.group.get(), m_groups.size());
    if (isNew) {
      m_groups.push_back(std::make_unique<ShapeArray>());
      m_groupScenes.push_back(makeScene(*instance.group, *m_groups.back()));
      rtcCommitScene(m_groupScenes.back());
    }
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, m_groupScenes[entry->second]);
    // Imath's rows are Embree's columns.
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, instance.toWorld.getValue());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(m_scene, geometry, unsigned(m_shapes.size() + m_placements.size()));
    rtcReleaseGeometry(geometry);
    const Matrix4 inverse(Imath::M44d(instance.toWorld).inverse());
    m_placements.push_back({instance.toWorld, inverse, m_groups[entry->second].get()});
  }
  rtcCommitScene(m_scene);
  if (const RTCError error = rtcGetDeviceError(m_device); error != RTC_ERROR_NONE) {
    release();
    throw std::runtime_error(fmt::format("Embree cannot build the scene (error {})", int(error)));
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

RTCSceneTy* Intersector::makeScene(const std::vector<ShapePtr>& shapes, ShapeArray& array) {
  RTCScene scene = rtcNewScene(m_device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (const ShapePtr& shape : shapes) {
    RTCGeometry geometry = shape->makeGeometry(m_device);
    rtcAttachGeometryByID(scene, geometry, unsigned(array.size()));
    rtcReleaseGeometry(geometry);
    array.push_back(shape.get());
  }
  return scene;
}

bool Intersector::intersect(const Ray& ray, SurfacePoint& at) const {
  RTCRayHit rayHit;
  rayHit.ray = embreeRay(ray);
  rayHit.hit.geomID = rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embreeIntersect(m_scene, rayHit);
  const RTCHit& found = rayHit.hit;
  if (found.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  RawHit hit{rayHit.ray.tfar, found.u, found.v, found.primID, nullptr, nullptr};
  const Shape* shape;
  if (found.instID[0] == RTC_INVALID_GEOMETRY_ID) {
    shape = m_shapes[found.geomID];
  } else {
    const Placement& placement = m_placements[found.instID[0] - m_shapes.size()];
    shape = (*placement.shapes)[found.geomID];
    hit.instanceToWorld = &placement.toWorld;
    hit.worldToInstance = &placement.toInstance;
  }
  at = shape->surfacePoint(ray, hit);
  return true;
}

bool Intersector::occluded(const Ray& ray) const {
  RTCRay shadowRay = embreeRay(ray);
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
