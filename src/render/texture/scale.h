// A texture times a factor; see scale.cpp for its parameters.
#pragma once

#include "render/texture/texture.h"

namespace odis::render {

class ScaleTexture final : public Texture {
 public:
  ScaleTexture(TexturePtr nested, TexturePtr factor);

  Rgb rgb(const Vec2& uv) const override { return m_nested->rgb(uv) * m_factor->rgb(uv); }
  float scalar(const Vec2& uv) const override;
  Rgb rgbAt(const SurfacePoint& at) const override { return m_nested->rgbAt(at) * m_factor->rgbAt(at); }
  float scalarAt(const SurfacePoint& at) const override;
  Vec2 gradient(const Vec2& uv) const override;
  // Exact if one of the two is constant, otherwise the product of the means.
  Rgb mean() const override { return m_nested->mean() * m_factor->mean(); }
  bool isConstant() const override { return m_nested->isConstant() && m_factor->isConstant(); }

 private:
  TexturePtr m_nested, m_factor;
  bool m_grey;         // a factor that is one number scales `scalar` and `gradient` of the nested texture,
  float m_number = 1;  // which is this one
};

}  // namespace odis::render
