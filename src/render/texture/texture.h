// A texture: a function of the surface's uv coordinates.
#pragma once

#include <memory>

#include "render/math/surface_point.h"

namespace odis::render {

class Texture {
 public:
  virtual ~Texture() = default;

  // The linear RGB value (Rec. 709 primaries) at uv.
  virtual Rgb rgb(const Vec2& uv) const = 0;
  // The value as one number: the luminance of `rgb`, or the stored channel of a single-channel texture.
  virtual float scalar(const Vec2& uv) const { return luminance(rgb(uv)); }
  // The same at a point of a surface, of which some textures know more than its uv.
  virtual Rgb rgbAt(const SurfacePoint& at) const { return rgb(at.uv); }
  virtual float scalarAt(const SurfacePoint& at) const { return scalar(at.uv); }
  // (d scalar/du, d scalar/dv), for bump maps. Default: central differences with a step of 1/1024.
  virtual Vec2 gradient(const Vec2& uv) const {
    constexpr float h = 1.0f / 1024.0f;
    return {(scalar({uv.x + h, uv.y}) - scalar({uv.x - h, uv.y})) / (2 * h),
            (scalar({uv.x, uv.y + h}) - scalar({uv.x, uv.y - h})) / (2 * h)};
  }
  // The average over the texture's domain; exact for constants, an average of texels for bitmaps.
  virtual Rgb mean() const = 0;
  // Texels along u and v; (1, 1) where there are none.
  virtual Vec2i resolution() const { return {1, 1}; }
  // Whether the value is the same everywhere (then it is `mean()`).
  virtual bool isConstant() const { return false; }
};

using TexturePtr = std::shared_ptr<const Texture>;

}  // namespace odis::render
