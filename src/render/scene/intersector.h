// Rays against all shapes of a scene, by Embree.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "render/scene/scene.h"

struct RTCSceneTy;

namespace odis::render {

class Intersector {
 public:
  // Builds the acceleration structure on all cores. The shapes must outlive the intersector. Throws
  // std::bad_alloc for want of memory, std::runtime_error if Embree fails otherwise. `watertight`: no ray
  // passes between triangles that share an edge.
  Intersector(const std::vector<ShapePtr>& shapes, const std::vector<Instance>& instances, bool watertight);
  ~Intersector();
  Intersector(const Intersector&) = delete;

  Hit intersect(const Ray& ray) const;
  bool occluded(const Ray& ray) const;
  // Many rays at once, in packets: faster the more neighbours resemble each other, and never slower by much.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  void occluded(std::span<const Ray> rays, std::span<uint8_t> hidden) const;
  // The box around everything; false if there is nothing.
  bool box(Vec3& min, Vec3& max) const;
  uint64_t bytes() const { return m_bytes.load(); }  // what Embree allocated

 private:
  using ShapeArray = std::vector<const Shape*>;  // by Embree's geometry number
  // An instance.
  struct Placed {
    Placement placement;   // if it is still
    const Motion* motion;  // null if it is
    const ShapeArray* shapes;
  };

  Hit resolve(unsigned geometry, unsigned instance, const RawHit& hit) const;
  // Triangles of more than this extent are met in double precision.
  RTCSceneTy* makeScene(const std::vector<ShapePtr>& shapes, float largeExtent, ShapeArray& array);
  void release();

  std::atomic<int64_t> m_bytes = 0;
  RTCDeviceTy* m_device = nullptr;
  bool m_watertight;
  RTCSceneTy* m_scene = nullptr;
  std::vector<RTCSceneTy*> m_groupScenes;
  ShapeArray m_shapes;  // and null, for rays that met nothing
  std::vector<std::unique_ptr<ShapeArray>> m_groups;
  std::vector<Placed> m_placed;
};

}  // namespace odis::render
