// The shapes of scene files: their geometry, BSDFs and area lights, shape groups and instances.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "render/scene/boundaries.h"
#include "render/scene/builder.h"
#include "render/scene/scene.h"

namespace odis::render {

class ShapeLoader {
 public:
  ShapeLoader(Scene& scene, Builder& builder) : m_scene(scene), m_builder(builder) {}
  // Adds what a <shape> element stands for to the scene. Throws SceneError.
  void load(const Properties& node);
  // A sensor in a shape, with the shape that was made; null pointers if there is none.
  struct Meter {
    const Properties* node = nullptr;
    std::shared_ptr<const Shape> shape;
    std::shared_ptr<const Motion> motion;  // of the shape; null if it is still
  };
  const Meter& meter() const { return m_meter; }
  // Tells of boundaries of media that all shapes together leave open.
  void warnOfOpenBoundaries() { m_boundaries.warn(m_builder.warnings()); }

 private:
  using Group = std::shared_ptr<const std::vector<ShapePtr>>;

  // A shape with all that is nested in it, and how it moves, null if it doesn't.
  struct Made {
    ShapePtr shape;  // null: nothing to draw
    std::shared_ptr<const Motion> motion;
  };
  Made make(const Properties& node, bool grouped);
  // Looks at a shape that bounds media. Throws SceneError.
  void checkBoundary(const Made& made, const Properties& node);
  ShapePtr makeStill(const Properties& node, bool grouped);
  // What the value of a texture is used for: a parameter of `owner`, which clamps it to `range`.
  struct TextureUse {
    const Properties* owner = nullptr;
    std::string parameter;
    NumberRange range = kAnyNumber;
    double factor = 1;  // by which the value is multiplied before
  };
  // Warns of textures, in a BSDF or an emitter of the shape, that name an attribute which it does not have,
  // or one with values that are clamped.
  void checkAttributes(const Shape& shape, const Properties& shapeNode, const Properties& node,
                       const TextureUse& use);
  void checkAttribute(const Shape& shape, const Properties& shapeNode, const Properties& texture,
                      const TextureUse& use);
  void setEmitter(Shape& shape, const Properties& node, bool grouped);
  // The media that an element names for both sides.
  void setMedia(Shape& shape, const Properties& node);
  Group group(const Properties& node);
  void collect(const Properties& node, std::vector<ShapePtr>& shapes);
  void loadInstance(const Properties& node);

  Scene& m_scene;
  Builder& m_builder;
  std::map<const Properties*, Group> m_groups;
  Meter m_meter;
  const Properties* m_currentGroup = nullptr;  // whose shapes are made
  Boundaries m_boundaries;
  BsdfPtr m_defaultBsdf, m_black;
};

}  // namespace odis::render
