// Two textures in alternate cells; see checkerboard.cpp for its parameters.
#pragma once

#include "render/texture/texture.h"
#include "render/texture/uv_transform.h"

namespace odis::render {

class CheckerboardTexture final : public Texture {
 public:
  CheckerboardTexture(TexturePtr color0, TexturePtr color1, const UvTransform& toUv)
      : m_colors{std::move(color0), std::move(color1)}, m_toUv(toUv) {}

  Rgb rgb(const Vec2& uv) const override { return m_colors[cell(uv)]->rgb(uv); }
  // Swapped, as Mitsuba does.
  float scalar(const Vec2& uv) const override { return m_colors[1 - cell(uv)]->scalar(uv); }
  Rgb rgbAt(const SurfacePoint& at) const override { return m_colors[cell(at.uv)]->rgbAt(at); }
  float scalarAt(const SurfacePoint& at) const override { return m_colors[1 - cell(at.uv)]->scalarAt(at); }
  // Of the cell's own texture: the steps between cells have no derivative.
  Vec2 gradient(const Vec2& uv) const override { return m_colors[1 - cell(uv)]->gradient(uv); }
  Rgb mean() const override { return (m_colors[0]->mean() + m_colors[1]->mean()) * 0.5f; }

 private:
  int cell(const Vec2& uv) const {
    const Vec2 st = m_toUv.apply(uv);
    const bool right = st.x - std::floor(st.x) > 0.5f, lower = st.y - std::floor(st.y) > 0.5f;
    return right == lower ? 0 : 1;
  }

  TexturePtr m_colors[2];
  UvTransform m_toUv;
};

}  // namespace odis::render
