#include "render/scene/scene.h"

#include <algorithm>
#include <unordered_set>

#include "render/scene/intersector.h"
#include "render/scene/spawn.h"

namespace odis::render {

Scene::Scene() = default;
Scene::~Scene() = default;

void Scene::addShape(ShapePtr shape) {
  if (shape->emitter()) enlist(*shape->emitter());
  lookAt(*shape);
  m_shapes.push_back(std::move(shape));
}

void Scene::addInstance(Instance instance) {
  for (const ShapePtr& shape : *instance.group) lookAt(*shape);
  if (instance.motion) {
    m_moves = true;
    for (const ShapePtr& shape : *instance.group) {
      if (!shape->emitter()) continue;
      shape->emitter()->setMotion(instance.motion);
      enlist(*shape->emitter());
    }
  }
  m_instances.push_back(std::move(instance));
}

void Scene::enlist(const Medium* medium) {
  if (!medium) return;
  if (std::find(m_media.begin(), m_media.end(), medium) == m_media.end()) m_media.push_back(medium);
}

void Scene::lookAt(const Shape& shape) {
  m_passesStraight |= shape.passesStraight();
  enlist(shape.interior());
  enlist(shape.exterior());
}

void Scene::enlist(Emitter& emitter) {
  emitter.setIndex(uint32_t(m_emitters.size()));
  m_emitters.push_back(&emitter);
  if (emitter.motion()) m_moves = true;
}

void Scene::setSensor(std::shared_ptr<const Sensor> sensor) {
  m_sensor = std::move(sensor);
  if (m_sensor->motion()) m_moves = true;
  enlist(m_sensor->medium());
}

void Scene::addEmitter(EmitterPtr emitter) {
  enlist(*emitter);
  if (const auto* environment = dynamic_cast<const EnvironmentEmitter*>(emitter.get()))
    m_environments.push_back(environment);
  m_ownedEmitters.push_back(std::move(emitter));
}

void Scene::finish() {
  m_intersector = std::make_unique<Intersector>(m_shapes, m_instances, m_watertight);
  // A scene of lights alone still has an extent, so that it may be divided by.
  if (!m_intersector->box(m_bounds.min, m_bounds.max)) m_bounds.min = m_bounds.max = Vec3(0, 0, 0);
  m_bounds.center = (m_bounds.min + m_bounds.max) * 0.5f;
  m_bounds.radius = length(m_bounds.max - m_bounds.center);
  if (!(m_bounds.radius > 0)) m_bounds.radius = 1;
}

bool Scene::intersect(const Ray& ray, SurfacePoint& at) const {
  Hit hit;
  if (!intersect(ray, hit)) return false;
  at = hit.surfacePoint(ray);
  return true;
}

bool Scene::intersect(const Ray& ray, Hit& hit) const {
  hit = m_intersector->intersect(ray);
  return hit.shape != nullptr;
}

bool Scene::occluded(const Ray& ray) const {
  return m_intersector->occluded(ray);
}

void Scene::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
  m_intersector->intersect(rays, hits);
}

void Scene::occluded(std::span<const Ray> rays, std::span<uint8_t> hidden) const {
  m_intersector->occluded(rays, hidden);
}

Ray Scene::spawn(const SurfacePoint& at, const Vec3& direction, float distance) {
  return spawnRay(at.p, at.ng, at.pError, direction, distance, at.time);
}

uint64_t Scene::bytes() const {
  uint64_t bytes = m_intersector ? m_intersector->bytes() : 0;
  for (const ShapePtr& shape : m_shapes) bytes += shape->bytes();
  for (const Medium* medium : m_media) bytes += medium->bytes();
  std::unordered_set<const void*> counted;
  for (const Instance& instance : m_instances) {
    if (!counted.insert(instance.group.get()).second) continue;
    for (const ShapePtr& shape : *instance.group) bytes += shape->bytes();
  }
  return bytes;
}

}  // namespace odis::render
