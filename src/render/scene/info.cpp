#include "render/scene/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace odis::render {

// What is not read as it is written, with every place.
static std::string listOf(const Warnings& warnings) {
  std::string text;
  constexpr std::pair<const char*, Effect> lists[] = {
      {"differences ", Effect::difference}, {"notes       ", Effect::same}, {"no effect   ", Effect::none}};
  for (const auto& [name, effect] : lists) {
    if (warnings.count(effect) == 0 && effect != Effect::difference) continue;
    text += fmt::format("{} {}\n", name, warnings.count(effect));
    for (const Warnings::Group& group : warnings.groups(effect)) {
      text += "  " + group.text() + "\n";
      for (const SourceLocation& other : group.others) text += "    " + onOneLine(other.text()) + "\n";
    }
  }
  return text;
}

std::string describe(const Scene& scene, const Warnings& warnings) {
  uint64_t primitives = 0, lights = 0, instanced = 0;
  std::set<const Bsdf*> bsdfs;
  std::set<const std::vector<ShapePtr>*> groups;
  const auto add = [&](const Shape& shape) {
    primitives += shape.primitiveCount();
    bsdfs.insert(&shape.bsdf());
    lights += shape.emitter() != nullptr;
  };
  for (const ShapePtr& shape : scene.shapes()) add(*shape);
  for (const Instance& instance : scene.instances()) {
    for (const ShapePtr& shape : *instance.group) instanced += shape->primitiveCount();
    if (!groups.insert(instance.group.get()).second) continue;
    for (const ShapePtr& shape : *instance.group) add(*shape);
  }
  const uint64_t moving = std::count_if(scene.instances().begin(), scene.instances().end(),
                                        [](const Instance& instance) { return instance.motion != nullptr; });
  const uint64_t movingLights =
      std::count_if(scene.emitters().begin(), scene.emitters().end(),
                    [](const Emitter* emitter) { return emitter->motion() != nullptr; });
  const SceneBounds& bounds = scene.bounds();
  const FilmSettings& film = scene.film();
  const IntegratorSettings& integrator = scene.integrator();
  const uint64_t environments = scene.environments().size();
  std::string text = fmt::format("shapes       {}, of {} primitives\n", scene.shapes().size(), primitives);
  if (!scene.instances().empty())
    text += fmt::format("instances    {} of {} groups, showing {} primitives\n", scene.instances().size(),
                        groups.size(), instanced);
  if (scene.moves())
    text += fmt::format("motion       of {} instances, {} emitters{}\n", moving, movingLights,
                        scene.sensor().motion() ? " and the sensor" : "");
  text += fmt::format("bsdfs        {}\n", bsdfs.size());
  text += fmt::format("emitters     {}: {} of shapes, {} environments, {} others\n", scene.emitters().size(),
                      lights, environments, scene.emitters().size() - lights - environments);
  if (const auto& media = scene.media(); !media.empty()) {
    const auto varying =
        std::count_if(media.begin(), media.end(), [](const Medium* m) { return m->varies(); });
    text += fmt::format("media        {}: {} homogeneous, {} heterogeneous{}\n", media.size(),
                        media.size() - size_t(varying), varying,
                        scene.sensor().medium() ? "; the sensor lies in one" : "");
  }
  text += fmt::format("bounds       ({}, {}, {}) to ({}, {}, {})\n", bounds.min.x, bounds.min.y, bounds.min.z,
                      bounds.max.x, bounds.max.y, bounds.max.z);
  text += fmt::format("film         {} x {}", film.width, film.height);
  if (film.crop.width != film.width || film.crop.height != film.height)
    text += fmt::format(", crop {} x {} at ({}, {})", film.crop.width, film.crop.height, film.crop.x,
                        film.crop.y);
  text += fmt::format(", filter {}\n", film.filter->name());
  const Ray view = scene.sensor().ray(Vec2(float(film.width), float(film.height)) * 0.5f, Vec2(0.5f), 0);
  text += fmt::format("sensor       at ({}, {}, {}), looks along ({}, {}, {})\n", view.origin.x,
                      view.origin.y, view.origin.z, view.direction.x, view.direction.y, view.direction.z);
  text +=
      fmt::format("integrator   {}, max depth {}", integrator.type.empty() ? "not named" : integrator.type,
                  integrator.maxDepth < 0 ? "unlimited" : std::to_string(integrator.maxDepth));
  if (integrator.samplesPerPixel > 0)
    text += fmt::format(", {} samples per pixel", integrator.samplesPerPixel);
  text += fmt::format("\nmemory       {:.1f} MiB\n", double(scene.bytes()) / (1024 * 1024));
  return text + listOf(warnings);
}

}  // namespace odis::render
