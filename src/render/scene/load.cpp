// Scene::load: from the tree of Properties to a scene that can be rendered.
#include <limits>

#include "render/scene/builder.h"
#include "render/scene/load_film.h"
#include "render/scene/load_shapes.h"
#include "render/scene/scene.h"
#include "render/sensor/perspective.h"
#include "render/sensor/registry.h"
#include "render/xml/xml.h"

namespace odis::render {
namespace {

IntegratorSettings loadIntegrator(const Properties* node, Warnings& warnings) {
  IntegratorSettings settings;
  settings.type = "";
  if (!node) return settings;
  settings.type = node->type;
  if (node->type != "path" && node->type != "odis" && !node->type.empty())
    warnings.add(
        node->location,
        "the integrator '" + node->type +
            "' is not one of path and odis, the integrator of this program is used with its path depths");
  // Integrators that record something about another hold that other one.
  while (const Properties* nested = node->child("integrator")) node = nested;
  const auto depth = [&](const char* name, int fallback, int least) {
    const int64_t value = node->integer(name, fallback);
    if (value < least || value > std::numeric_limits<int>::max())
      throw SceneError(node->parameters.at(name).location, "found " + std::to_string(value) + " for '" +
                                                               name + "', expected " + std::to_string(least) +
                                                               " or more");
    return int(value);
  };
  settings.maxDepth = depth("max_depth", -1, -1);
  // 0.6 counts it from one, too, but allows a zero.
  settings.rrDepth = depth("rr_depth", 5, 0);
  if (node->has("hide_emitters") && node->boolean("hide_emitters"))
    warnings.add(node->parameters.at("hide_emitters").location,
                 "'hide_emitters' is not supported and is ignored");
  return settings;
}

int loadSampleCount(const Properties* sampler, Warnings& warnings) {
  if (!sampler) return 0;
  if (sampler->type != "independent" && sampler->type != "sobol")
    warnings.add(sampler->location, "the sampler '" + sampler->type +
                                        "' is not one of independent and sobol, the sampler of this program "
                                        "is used with its sample count");
  if (!sampler->has("sample_count")) return 0;
  const int64_t count = sampler->integer("sample_count");
  if (count < 1 || count > std::numeric_limits<int>::max())
    throw SceneError(sampler->parameters.at("sample_count").location,
                     "found " + std::to_string(count) + " for 'sample_count', expected 1 to " +
                         std::to_string(std::numeric_limits<int>::max()));
  return int(count);
}

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

}  // namespace

std::unique_ptr<Scene> Scene::load(const std::string& path, const LoadOptions& options, Warnings& warnings) {
  const ParsedScene parsed = parseScene(path, options.defines, warnings);
  const Properties& root = *parsed.root;
  Builder builder(warnings, parsed.folders);
  auto scene = std::make_unique<Scene>();
  ShapeLoader shapes(*scene, builder);

  const Properties *integrator = nullptr, *sensor = nullptr;
  for (const Properties::Child& child : root.children) {
    const Properties& node = *child.node;
    if (node.tag == "shape") {
      shapes.load(node);
    } else if (node.tag == "emitter" && node.type == "area") {
      // Shapes refer to such a light by its id.
      if (node.id.empty()) warnings.add(node.location, "an area light outside of a shape lights nothing");
    } else if (node.tag == "emitter") {
      for (EmitterPtr& emitter : builder.emitters(node)) scene->addEmitter(std::move(emitter));
    } else if (node.tag == "medium") {
      shapes.warnOfMedia(node);
    } else if (node.tag == "integrator" || node.tag == "sensor") {
      const Properties*& first = node.tag == "sensor" ? sensor : integrator;
      if (first)
        warnings.add(node.location, "a scene has one " + node.tag + " only, this further one is ignored");
      if (!first) first = &node;
    }
  }
  scene->finish();

  // Scenes of 0.5 may keep film and sampler beside the sensor.
  const auto part = [&](const char* tag) {
    const Properties* nested = sensor ? sensor->child(tag) : nullptr;
    return nested ? nested : root.child(tag);
  };
  const FilmSettings film = loadFilm(part("film"), options, warnings);
  scene->setFilm(film);
  IntegratorSettings settings = loadIntegrator(integrator, warnings);
  settings.samplesPerPixel = loadSampleCount(part("sampler"), warnings);
  scene->setIntegrator(settings);
  const Vec2i resolution(film.width, film.height);
  if (sensor) {
    scene->setSensor(makeSensor(*sensor, resolution, warnings));
    if (sensor->child("medium")) shapes.warnOfMedia(*sensor);
    builder.warnUnqueried(*sensor);
  } else {
    warnings.add({path}, "the scene has no sensor, all of it is shown from its +z side");
    scene->setSensor(defaultSensor(scene->bounds(), resolution));
  }
  scene->m_files = parsed.files;
  scene->m_files.insert(scene->m_files.end(), builder.files().begin(), builder.files().end());
  if (scene->shapes().empty() && scene->instances().empty()) warnings.add({path}, "the scene has no shapes");
  if (scene->emitters().empty()) warnings.add({path}, "the scene has no emitter, its image is black");
  return scene;
}

}  // namespace odis::render
