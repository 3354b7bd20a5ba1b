// A scene ready to be rendered.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/emitter/emitter.h"
#include "render/film/film_settings.h"
#include "render/sensor/sensor.h"
#include "render/shape/shape.h"
#include "render/xml/error.h"

namespace odis::render {

class Intersector;

// The axis-aligned box and the sphere around everything that a ray can hit.
struct SceneBounds {
  Vec3 min, max;
  Vec3 center;
  float radius = 0;
};

// The depth of paths that bring emission and direct light.
inline constexpr int kDirectLightDepth = 2;

// What the file asks for and the command line may override.
struct IntegratorSettings {
  std::string type = "odis";  // as named by the file, "" if it names none
  int maxDepth = -1;  // -1: unlimited; 1 is directly visible emission, 2 direct light, as Mitsuba counts
  int rrDepth = 5;
  int samplesPerPixel = 0;    // 0: the file names none
  bool hideEmitters = false;  // whether the camera doesn't see lights, the surroundings neither
  bool volumetric = false;    // whether the file asks for one that knows of media
};

struct LoadOptions {
  std::map<std::string, std::string> defines;  // -D key=value
  std::optional<Vec2i> resolution;  // replaces the film's size; keeps the file's crop only if absent
  int pixels =
      0;  // without a resolution: about so many pixels, at the film's own aspect ratio; 0: as the file has it
  std::optional<Crop> crop;
};

// A shape group, or a shape that moves, placed in the world.
struct Instance {
  std::shared_ptr<const std::vector<ShapePtr>> group;
  Matrix4 toWorld;
  std::shared_ptr<const Motion> motion;  // in place of `toWorld`; null: it stays there
};

class Scene {
 public:
  // Loads a Mitsuba XML file; throws SceneError, and OptionError for options that do not suit it.
  static std::unique_ptr<Scene> load(const std::string& path, const LoadOptions& options, Warnings& warnings);
  Scene();
  ~Scene();

  // The nearest surface along the ray, if any. Thread-safe.
  bool intersect(const Ray& ray, SurfacePoint& at) const;
  // The same, for those who may not need the place: hit.surfacePoint(ray).
  bool intersect(const Ray& ray, Hit& hit) const;
  // Whether anything lies within (0, ray.tMax). Thread-safe.
  bool occluded(const Ray& ray) const;
  // The same for many rays at once; shape null where a ray met nothing. hit.surfacePoint(ray) gives the
  // place.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  void occluded(std::span<const Ray> rays, std::span<uint8_t> hidden) const;

  // A ray that leaves `at` and does not meet the surface again at its start.
  static Ray spawn(const SurfacePoint& at, const Vec3& direction, float distance = kInfinity);

  // Whether anything moves while the shutter is open, so that rays need a time.
  bool moves() const { return m_moves; }
  // Whether paths follow the rules of Mitsuba's `volpath`: what they pass straight through counts neither as
  // depth nor for `hideEmitters`, and shadow rays pass it, too. So it is where there are media, or where the
  // file names an integrator for media and there is something to pass.
  bool volumetric() const { return !m_media.empty() || (m_integrator.volumetric && m_passesStraight); }
  // Whether there is anything that may let light pass straight through.
  bool passesStraight() const { return m_passesStraight; }
  // Each once: those that shapes bound, and the sensor's.
  const std::vector<const Medium*>& media() const { return m_media; }
  // Of all that is there while the shutter is open.
  const SceneBounds& bounds() const { return m_bounds; }
  const Sensor& sensor() const { return *m_sensor; }
  const FilmSettings& film() const { return m_film; }
  const IntegratorSettings& integrator() const { return m_integrator; }
  const std::vector<ShapePtr>& shapes() const { return m_shapes; }
  const std::vector<Instance>& instances() const { return m_instances; }
  // All light sources by their index: surface emitters of shapes, delta lights, environments.
  const std::vector<const Emitter*>& emitters() const { return m_emitters; }
  const std::vector<const EnvironmentEmitter*>& environments() const { return m_environments; }
  // What it was read from: scene files, meshes, textures, spectra.
  const std::vector<std::string>& files() const { return m_files; }
  uint64_t bytes() const;  // memory of geometry, acceleration structure and textures

  // For building scenes in code (tests, the loader): add, then finish() once.
  void addShape(ShapePtr shape);        // with its BSDF and emitter set
  void addInstance(Instance instance);  // if it moves, its shapes may emit light: no others may share them
  void addEmitter(EmitterPtr emitter);
  void setSensor(std::shared_ptr<const Sensor> sensor);
  void setFilm(const FilmSettings& film) { m_film = film; }
  void setIntegrator(const IntegratorSettings& settings) { m_integrator = settings; }
  // Whether no ray passes between triangles that share an edge, which takes longer.
  void setWatertight(bool watertight) { m_watertight = watertight; }
  void finish();

 private:
  // Counts a medium, if it is one.
  void enlist(const Medium* medium);
  void lookAt(const Shape& shape);
  // Gives an emitter its index.
  void enlist(Emitter& emitter);

  std::vector<ShapePtr> m_shapes;
  std::vector<Instance> m_instances;
  std::vector<EmitterPtr> m_ownedEmitters;
  std::vector<const Emitter*> m_emitters;
  std::vector<const EnvironmentEmitter*> m_environments;
  std::vector<const Medium*> m_media;
  std::shared_ptr<const Sensor> m_sensor;
  FilmSettings m_film;
  IntegratorSettings m_integrator;
  SceneBounds m_bounds;
  bool m_moves = false, m_watertight = false, m_passesStraight = false;
  std::vector<std::string> m_files;
  std::unique_ptr<Intersector> m_intersector;
};

}  // namespace odis::render
