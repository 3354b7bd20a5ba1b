// A texture from an image file; see bitmap.cpp for its parameters.
#pragma once

#include "render/image/image.h"
#include "render/texture/texture.h"
#include "render/texture/uv_transform.h"
#include "render/texture/wrap_mode.h"

namespace odis::render {

class BitmapTexture final : public Texture {
 public:
  struct Options {
    WrapMode wrapU = WrapMode::repeat, wrapV = WrapMode::repeat;
    bool nearest = false;  // else bilinear
    UvTransform toUv;
  };

  BitmapTexture(std::shared_ptr<const Image> image, const Options& options);

  Rgb rgb(const Vec2& uv) const override;
  float scalar(const Vec2& uv) const override;
  // Without a second virtual call: these are looked up most.
  Rgb rgbAt(const SurfacePoint& at) const override { return rgb(at.uv); }
  float scalarAt(const SurfacePoint& at) const override { return scalar(at.uv); }
  // Exact derivative of the bilinear patch; zero with `nearest`.
  Vec2 gradient(const Vec2& uv) const override;
  Rgb mean() const override { return m_mean; }
  Vec2i resolution() const override { return {m_image->width(), m_image->height()}; }
  bool isConstant() const override { return m_constant; }
  // The least and the greatest number of the image.
  Vec2 range() const;

 private:
  struct Patch;
  Patch patch(const Vec2& uv) const;
  template <class T, class Fetch>
  T texel(int x, int y, Fetch&& fetch) const;
  template <class T, class Fetch>
  T interpolate(const Vec2& uv, Fetch&& fetch) const;

  std::shared_ptr<const Image> m_image;
  Options m_options;
  Rgb m_mean;
  bool m_constant;
};

}  // namespace odis::render
