// Volume: a volume (a grid, a constant) as it is where the surface is, in world space.
//
//   volume   volume, number or colour   default 0.75
#include "render/scene/builder.h"

namespace odis::render {
namespace {

class VolumeTexture final : public Texture {
 public:
  explicit VolumeTexture(VolumePtr volume) : m_volume(std::move(volume)) {}

  Rgb rgbAt(const SurfacePoint& at) const override { return m_volume->rgb(at.p); }
  float scalarAt(const SurfacePoint& at) const override { return m_volume->scalar(at.p); }
  // There is no place, only a uv: the middle of what the volume holds.
  Rgb rgb(const Vec2&) const override { return mean(); }
  Vec2 gradient(const Vec2&) const override { return {0.0f, 0.0f}; }
  Rgb mean() const override { return (m_volume->least() + m_volume->greatest()) * 0.5f; }
  bool isConstant() const override { return m_volume->isConstant(); }

 private:
  VolumePtr m_volume;
};

}  // namespace

TexturePtr makeVolumeTexture(const Properties& node, Builder& builder) {
  return std::make_shared<VolumeTexture>(
      builder.volume(node, "volume", {"colour, number or volume"}, Rgb(0.75f)));
}

}  // namespace odis::render
