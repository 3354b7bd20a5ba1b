// Scale (Mitsuba 0.6): the nested texture times a factor, mostly for the height of bump maps.
//
//   (nested)   texture                     required
//   scale      number, colour or texture   default 1
#include "render/texture/scale.h"

#include "render/scene/builder.h"

namespace odis::render {

ScaleTexture::ScaleTexture(TexturePtr nested, TexturePtr factor)
    : m_nested(std::move(nested)), m_factor(std::move(factor)) {
  const Rgb value = m_factor->mean();
  m_grey = m_factor->isConstant() && value.x == value.y && value.y == value.z;
  if (m_grey) m_number = value.x;
}

float ScaleTexture::scalar(const Vec2& uv) const {
  return m_grey ? m_number * m_nested->scalar(uv) : luminance(rgb(uv));
}

float ScaleTexture::scalarAt(const SurfacePoint& at) const {
  return m_grey ? m_number * m_nested->scalarAt(at) : luminance(rgbAt(at));
}

Vec2 ScaleTexture::gradient(const Vec2& uv) const {
  return m_grey ? m_nested->gradient(uv) * m_number : Texture::gradient(uv);
}

TexturePtr makeScaleTexture(const Properties& node, Builder& builder) {
  const TexturePtr factor = builder.texture(node, "scale", kAnyTexture, Rgb(1.0f));
  for (const Properties::Child& child : node.children) {
    if (child.node->tag != "texture" || child.name == "scale") continue;
    child.queried = true;
    return std::make_shared<ScaleTexture>(builder.texture(*child.node), factor);
  }
  throw SceneError(node.location, "a scale texture without a nested texture, expected one to be scaled");
}

}  // namespace odis::render
