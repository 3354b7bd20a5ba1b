#include "render/scene/load_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "render/xml/names.h"

namespace odis::render {
namespace {

// The children with this tag, marked as queried.
std::vector<const Properties*> childrenOf(const Properties& node, const std::string& tag) {
  std::vector<const Properties*> result;
  for (const Properties::Child& child : node.children) {
    if (child.node->tag != tag) continue;
    child.queried = true;
    result.push_back(child.node.get());
  }
  return result;
}

// Grids lie in world space: they would stay behind.
void refuseMotion(const std::vector<ShapePtr>& shapes, const Motion* motion, const SourceLocation& at) {
  if (!motion) return;
  for (const ShapePtr& shape : shapes)
    for (const Medium* medium : {shape->interior(), shape->exterior()})
      if (medium && medium->varies())
        throw SceneError(at,
                         "found an animation for the boundary of a medium that varies from place to place, "
                         "expected one that stands still, or a homogeneous medium");
}

}  // namespace

void ShapeLoader::load(const Properties& node) {
  if (node.type == "shapegroup") return;  // drawn where an instance refers to it
  if (node.type == "instance" || node.type == "merge")
    for (const Properties* medium : childrenOf(node, "medium"))
      m_builder.warn(
          medium->location,
          "the shape '" + node.type + "' bounds no medium, the shapes within it do; this one is left out");
  if (node.type == "instance") {
    loadInstance(node);
  } else if (node.type == "merge") {
    for (const Properties* part : childrenOf(node, "shape")) load(*part);
  } else if (auto [shape, motion] = make(node, false); motion) {
    m_scene.addInstance({std::make_shared<const std::vector<ShapePtr>>(1, std::move(shape)), {}, motion});
  } else if (shape) {
    m_scene.addShape(std::move(shape));
  }
}

ShapeLoader::Made ShapeLoader::make(const Properties& node, bool grouped) {
  std::optional<Placed> placed = m_builder.placed(node, Scale::kept);
  if (!placed) {
    Made still{makeStill(node, grouped), nullptr};
    checkBoundary(still, node);
    return still;
  }
  if (grouped && placed->motion) {
    m_builder.warn(node.placeOf("to_world"),
                   "a shape can't move within its shape group, it stays where it is when the shutter opens");
    placed->node.parameters.at("to_world").value = Imath::M44d(placed->motion->matrixAt(0));
    placed->motion = nullptr;
  }
  Made made{makeStill(placed->node, grouped), placed->motion};
  if (!made.shape) return {};
  checkBoundary(made, node);
  if (m_meter.shape == made.shape) m_meter.motion = made.motion;
  return made;
}

void ShapeLoader::checkBoundary(const Made& made, const Properties& node) {
  if (!made.shape || !made.shape->boundsMedia()) return;
  m_boundaries.add(*made.shape, made.motion.get(), node.location, m_currentGroup);
  refuseMotion({made.shape}, made.motion.get(), node.placeOf("to_world"));
}

ShapePtr ShapeLoader::makeStill(const Properties& node, bool grouped) {
  std::vector<std::string> known = shapeTypes();
  if (std::find(known.begin(), known.end(), node.type) == known.end()) {
    known.insert(known.end(), {"instance", "shapegroup", "merge"});
    m_builder.warn(node.location, "the shape '" + node.type + "' is unknown" + suggestion(node.type, known) +
                                      ", it is left out");
    return nullptr;
  }
  ShapePtr shape = makeShape(node, m_builder);
  if (!shape) return nullptr;
  const std::vector<const Properties*> bsdfs = childrenOf(node, "bsdf"),
                                       emitters = childrenOf(node, "emitter");
  if (bsdfs.size() > 1)
    m_builder.warn(bsdfs[1]->location, "a shape has one BSDF only, this second one is ignored");
  if (!bsdfs.empty()) {
    shape->setBsdf(m_builder.bsdf(*bsdfs[0]));
  } else if (node.before2 && node.child("medium")) {
    // As in Mitsuba 0.6 a boundary without a BSDF bends no light.
    shape->setBsdf(findBsdfFactory("null")(Properties(), m_builder));
  } else {
    // As in Mitsuba 3: grey, but a light reflects nothing.
    BsdfPtr& bsdf = emitters.empty() ? m_defaultBsdf : m_black;
    Properties diffuse;
    diffuse.tag = "bsdf";
    diffuse.type = "diffuse";
    if (!emitters.empty()) diffuse.parameters["reflectance"] = {0.0, {}};
    if (!bsdf) bsdf = findBsdfFactory("diffuse")(diffuse, m_builder);
    shape->setBsdf(bsdf);
  }
  for (const Properties* emitter : emitters) setEmitter(*shape, *emitter, grouped);
  checkAttributes(*shape, node, node, {});
  for (const Properties* sensor : childrenOf(node, "sensor"))
    if (!m_meter.node) m_meter = {sensor, shape, nullptr};
  setMedia(*shape, node);
  for (const Properties* subsurface : childrenOf(node, "subsurface"))
    m_builder.warn(subsurface->location,
                   "subsurface scattering is not supported, only the BSDF of the shape is drawn");
  m_builder.warnUnqueried(node);
  return shape;
}

void ShapeLoader::checkAttributes(const Shape& shape, const Properties& shapeNode, const Properties& node,
                                  const TextureUse& use) {
  for (const Properties::Child& child : node.children) {
    const Properties& part = *child.node;
    if (part.tag != "bsdf" && part.tag != "texture" && part.tag != "emitter") continue;
    TextureUse inside = use;
    if (node.tag != "texture") {
      const auto declared = node.declarations().find(child.name);
      inside = {&node, child.name,
                declared == node.declarations().end() ? kAnyNumber : declared->second.range};
    } else if (node.type == "scale") {
      const auto factor = node.parameters.find("scale");
      const double* number =
          factor == node.parameters.end() ? nullptr : std::get_if<double>(&factor->second.value);
      // What colours and textures make of it is not looked into.
      if (number) inside.factor *= *number;
      if (!number && (node.has("scale") || node.child("texture", "scale"))) inside.range = kAnyNumber;
    }
    if (part.type == "mesh_attribute") checkAttribute(shape, shapeNode, part, inside);
    checkAttributes(shape, shapeNode, part, inside);
  }
}

void ShapeLoader::checkAttribute(const Shape& shape, const Properties& shapeNode, const Properties& texture,
                                 const TextureUse& use) {
  const std::string name = texture.string("name", "");
  const std::optional<Vec2> range = shape.attributeRange(name);
  if (!range) {
    m_builder.warn(texture.location,
                   "a shape that it is used on has no attribute '" + name + "', it is black there");
    return;
  }
  const double factor = use.factor * texture.number("scale", kAnyNumber, 1.0f);
  const double least = range->x * factor, most = range->y * factor;
  if (use.range.contains(least) && use.range.contains(most)) return;
  const std::string path = m_builder.resolvePath(shapeNode.string("filename"), shapeNode.placeOf("filename"));
  m_builder.warn(
      {path, 0, 0},
      fmt::format("the attribute '{}' goes from {:.6g} to {:.6g}, '{}' of the {} '{}' is clamped to {}", name,
                  least, most, use.parameter, use.owner->tag, use.owner->type, use.range.text()));
}

void ShapeLoader::setEmitter(Shape& shape, const Properties& node, bool grouped) {
  if (node.type == "directionalarea") {
    m_builder.warn(
        node.location,
        "a 'directionalarea' shines along its normals alone, where paths from a sensor never meet it "
        "(in Mitsuba's `path` neither); it is left out");
  } else if (node.type != "area") {
    m_builder.warn(node.location, "the emitter '" + node.type + "' of a shape is unknown" +
                                      suggestion(node.type, {"area"}) + ", it is left out");
  } else if (grouped) {
    m_builder.warn(node.location, "emitters can't be instanced, this one is left out");
  } else if (!shape.canEmit()) {
    m_builder.warn(node.location, "a shape of this type can't emit, its emitter is left out");
  } else if (shape.emitter()) {
    m_builder.warn(node.location, "a shape has one emitter only, this second one is ignored");
  } else {
    shape.setEmitter(makeSurfaceEmitter(node, shape, m_builder));
    m_builder.warnUnqueried(node);
  }
}

void ShapeLoader::setMedia(Shape& shape, const Properties& node) {
  MediumPtr sides[2];
  std::set<std::string> given;
  for (const Properties::Child& child : node.children) {
    if (child.node->tag != "medium") continue;
    child.queried = true;
    if (child.name == "interior" || child.name == "exterior") {
      MediumPtr& side = sides[child.name == "exterior"];
      if (!given.insert(child.name).second)
        m_builder.warn(child.node->location,
                       "a shape has one " + child.name + " medium only, this second one is ignored");
      else
        side = m_builder.medium(*child.node);
    } else {
      m_builder.warn(child.node->location, "found a medium of a shape by the name '" + child.name +
                                               "', expected 'interior' or 'exterior'; it is left out");
    }
  }
  shape.setMedia(sides[0], sides[1]);
}

ShapeLoader::Group ShapeLoader::group(const Properties& node) {
  Group& known = m_groups[&node];
  if (known) return known;
  std::vector<ShapePtr> shapes;
  m_currentGroup = &node;
  collect(node, shapes);
  m_currentGroup = nullptr;
  m_builder.warnUnqueried(node);
  return known = std::make_shared<const std::vector<ShapePtr>>(std::move(shapes));
}

void ShapeLoader::collect(const Properties& node, std::vector<ShapePtr>& shapes) {
  for (const Properties* part : childrenOf(node, "shape")) {
    if (part->type == "instance" || part->type == "shapegroup") {
      throw SceneError(part->location, "found the shape '" + part->type + "' in a " + node.type +
                                           ", expected shapes that are not instanced themselves");
    } else if (part->type == "merge") {
      collect(*part, shapes);
    } else if (ShapePtr shape = make(*part, true).shape) {
      shapes.push_back(std::move(shape));
    }
  }
}

void ShapeLoader::loadInstance(const Properties& node) {
  const std::vector<const Properties*> groups = childrenOf(node, "shape");
  if (groups.size() != 1 || groups[0]->type != "shapegroup")
    throw SceneError(
        node.location,
        "found an instance without its shape group, expected one <ref> to a <shape type=\"shapegroup\">");
  const Group shapes = group(*groups[0]);
  const std::optional<Placed> placed = m_builder.placed(node, Scale::kept);
  const Properties& still = placed ? placed->node : node;
  const Matrix4 toWorld = still.transform("to_world");
  m_builder.warnUnqueried(still);
  if (shapes->empty()) {
    m_builder.warn(node.location, "the shape group of this instance is empty, there is nothing to draw",
                   Effect::same);
    return;
  }
  if (placed) refuseMotion(*shapes, placed->motion.get(), node.placeOf("to_world"));
  m_scene.addInstance({shapes, toWorld, placed ? placed->motion : nullptr});
}

}  // namespace odis::render
