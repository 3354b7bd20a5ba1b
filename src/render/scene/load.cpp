// Scene::load: from the tree of Properties to a scene that can be rendered.
#include "render/scene/builder.h"
#include "render/scene/load_film.h"
#include "render/scene/load_integrator.h"
#include "render/scene/load_shapes.h"
#include "render/scene/missing_files.h"
#include "render/scene/scene.h"
#include "render/sensor/perspective.h"
#include "render/sensor/registry.h"
#include "render/xml/xml.h"

namespace odis::render {
namespace {

// For scenes without a camera: all of the scene, seen along -z.
std::shared_ptr<const Sensor> defaultSensor(const SceneBounds& bounds, const Vec2i& resolution) {
  constexpr double fov = 45 * M_PI / 180;
  const double width = 2 * std::tan(fov / 2), height = width * resolution.y / resolution.x;
  const double distance = std::max(bounds.radius, 1e-3f) / std::sin(std::atan(std::min(width, height) / 2));
  Matrix4 toWorld;
  toWorld[0][0] = toWorld[2][2] = -1;
  for (int i = 0; i < 3; ++i) toWorld[3][i] = bounds.center[i];
  toWorld[3][2] += float(distance);
  return std::make_shared<Perspective>(toWorld, Projection(fov, resolution));
}

// What of a scene there is one of; null if there is none.
struct Singles {
  const Properties *integrator = nullptr, *sensor = nullptr;
};

// Adds shapes and emitters to the scene.
Singles loadObjectsOf(const Properties& root, Scene& scene, ShapeLoader& shapes, Builder& builder) {
  Warnings& warnings = builder.warnings();
  Singles result;
  for (const Properties::Child& child : root.children) {
    const Properties& node = *child.node;
    if (node.tag == "shape") {
      shapes.load(node);
    } else if (node.tag == "emitter" && node.type == "area") {
      // Shapes refer to such a light by its id.
      if (node.id.empty()) warnings.add(node.location, "an area light outside of a shape lights nothing");
    } else if (node.tag == "emitter") {
      for (EmitterPtr& emitter : builder.emitters(node)) scene.addEmitter(std::move(emitter));
    } else if (node.tag == "integrator" || node.tag == "sensor") {
      const Properties*& first = node.tag == "sensor" ? result.sensor : result.integrator;
      if (first)
        warnings.add(node.location, "a scene has one " + node.tag + " only, this further one is ignored",
                     node.tag == "sensor" ? Effect::same : Effect::difference);
      if (!first) first = &node;
    } else if (node.id.empty() && node.tag != "film" && node.tag != "sampler") {
      // With an id others may refer to it.
      warnings.add(node.location,
                   "the " + node.tag + " '" + node.type + "' belongs to nothing and has no effect",
                   Effect::none);
    }
  }
  scene.setWatertight(root.boolean("embree_use_robust_intersections", false));
  for (const auto& [name, location] : root.unqueried())
    if (root.has(name))
      warnings.add(location, "'" + name + "' of the scene has no effect" + root.suggestionFor(name),
                   Effect::none);
  return result;
}

// The same. If a file is missing, the error tells of all that are.
Singles loadObjects(const ParsedScene& parsed, Scene& scene, ShapeLoader& shapes, Builder& builder) {
  try {
    const Singles singles = loadObjectsOf(*parsed.root, scene, shapes, builder);
    const Properties* sensor = singles.sensor ? singles.sensor : shapes.meter().node;
    if (const Properties* medium = sensor ? sensor->child("medium") : nullptr) builder.medium(*medium);
    return singles;
  } catch (const MissingFiles&) {
    std::vector<SceneError> all = missingFiles(parsed, builder.warnings());
    if (all.empty()) throw;
    throw MissingFiles(std::move(all));
  }
}

// The sensor that the scene is seen by, in a shape if there is no other; null if there is none.
const Properties* findSensor(const Properties& node) {
  for (const char* tag : {"sensor", "shape"})
    for (const Properties::Child& child : node.children) {
      if (child.node->tag != tag || child.node->type == "instance") continue;
      const Properties* sensor = child.node->tag == "sensor" ? child.node.get() : findSensor(*child.node);
      if (sensor) return sensor;
    }
  return nullptr;
}

}  // namespace

std::unique_ptr<Scene> Scene::load(const std::string& path, const LoadOptions& options, Warnings& warnings) {
  const ParsedScene parsed = parseScene(path, options.defines, warnings);
  if (!parsed.missing.empty()) throw MissingFiles(missingFiles(parsed, warnings));
  const Properties& root = *parsed.root;
  const Properties* seenBy = findSensor(root);
  Builder builder(warnings, parsed.folders, seenBy ? readShutter(*seenBy) : Shutter());
  builder.readAhead(root);
  auto scene = std::make_unique<Scene>();
  ShapeLoader shapes(*scene, builder);

  const Singles singles = loadObjects(parsed, *scene, shapes, builder);
  shapes.warnOfOpenBoundaries();
  const Properties* sensor = singles.sensor;
  scene->finish();

  const ShapeLoader::Meter meter = sensor ? ShapeLoader::Meter() : shapes.meter();
  if (meter.node) sensor = meter.node;
  // Scenes of 0.5 may keep film and sampler beside the sensor.
  const auto part = [&](const char* tag) {
    const Properties* nested = sensor ? sensor->child(tag) : nullptr;
    return nested ? nested : root.child(tag);
  };
  const FilmSettings film = loadFilm(part("film"), options, warnings);
  scene->setFilm(film);
  scene->setIntegrator(loadIntegrator(singles.integrator, part("sampler"), warnings));
  const Vec2i resolution(film.width, film.height);
  if (sensor) {
    const Properties* medium = sensor->child("medium");
    const std::shared_ptr<Sensor> made = meter.shape ? makeMeter(*sensor, resolution, meter.shape, builder)
                                                     : makeSensor(*sensor, resolution, builder);
    if (meter.shape) made->setMotion(meter.motion);
    if (medium) made->setMedium(builder.medium(*medium));
    scene->setSensor(made);
  } else {
    warnings.add({path}, "the scene has no sensor, all of it is shown from its +z side", Effect::same);
    scene->setSensor(defaultSensor(scene->bounds(), resolution));
  }
  scene->m_files = parsed.files;
  scene->m_files.insert(scene->m_files.end(), builder.files().begin(), builder.files().end());
  if (scene->shapes().empty() && scene->instances().empty())
    warnings.add({path}, "the scene has no shapes", Effect::same);
  if (scene->emitters().empty()) warnings.add({path}, "the scene has no emitter, its image is black");
  return scene;
}

}  // namespace odis::render
