// A texture of numbers that a mesh has at its vertices or faces; see mesh_attribute.cpp for its parameters.
#pragma once

#include <string>

#include "render/texture/texture.h"

namespace odis::render {

class MeshAttributeTexture final : public Texture {
 public:
  MeshAttributeTexture(std::string name, float scale) : m_name(std::move(name)), m_scale(scale) {}

  // Black: there is nothing to be known from uv alone.
  Rgb rgb(const Vec2&) const override { return Rgb(0); }
  Rgb rgbAt(const SurfacePoint& at) const override;
  float scalarAt(const SurfacePoint& at) const override { return luminance(rgbAt(at)); }
  // A guess: which mesh it is of shows where it is looked up.
  Rgb mean() const override { return Rgb(0.5f * m_scale); }

 private:
  std::string m_name;
  float m_scale;
};

}  // namespace odis::render
