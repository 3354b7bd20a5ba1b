// A texture with the same value everywhere: what a colour or a number in place of a texture means.
#pragma once

#include "render/texture/texture.h"

namespace odis::render {

class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const Rgb& value) : m_value(value), m_scalar(luminance(value)) {
    if (value.x == value.y && value.y == value.z) m_scalar = value.x;  // a grey comes back without rounding
  }

  Rgb rgb(const Vec2&) const override { return m_value; }
  float scalar(const Vec2&) const override { return m_scalar; }
  Vec2 gradient(const Vec2&) const override { return {0.0f, 0.0f}; }
  Rgb mean() const override { return m_value; }
  bool isConstant() const override { return true; }

 private:
  Rgb m_value;
  float m_scalar;
};

}  // namespace odis::render
