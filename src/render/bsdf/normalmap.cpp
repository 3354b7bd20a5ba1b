// normalmap: replaces the shading normal by one from a texture.
//
//   normalmap                rgb texture without gamma, (n + 1) / 2 for the normal n in the shading
//                            frame; required
//   (nested bsdf)            one
//   flip_invalid_normals     whether to mirror a perturbed normal that faces away from the viewer; true
//   use_shadowing_function   whether to smooth the terminator; true
#include "render/bsdf/factories.h"
#include "render/bsdf/perturbed.h"

namespace odis::render {
namespace {

class NormalMap final : public Perturbed {
 public:
  NormalMap(BsdfPtr nested, TexturePtr normals, const PerturbationOptions& options)
      : Perturbed(std::move(nested), options), m_normals(std::move(normals)) {}

 private:
  Vec3 normal(const SurfacePoint& at) const override {
    const Rgb c = m_normals->rgbAt(at);
    const Vec3 n(2 * c.x - 1, 2 * c.y - 1, 2 * c.z - 1);
    return lengthSquared(n) > 0 ? normalize(n) : Vec3(0, 0, 1);
  }

  Vec3 tangent(const SurfacePoint&) const override { return {1, 0, 0}; }

  TexturePtr m_normals;
};

}  // namespace

BsdfPtr makeNormalMap(BsdfPtr nested, TexturePtr normals, const PerturbationOptions& options) {
  return std::make_shared<NormalMap>(std::move(nested), std::move(normals), options);
}

BsdfPtr makeNormalMap(const Properties& properties, Builder& builder) {
  TexturePtr normals =
      builder.optionalTexture(properties, "normalmap", {.type = "texture", .otherwise = "any texture in it"});
  if (!normals) {
    // Files of earlier versions nest the texture under any name.
    const Properties* nested = properties.child("texture");
    if (!nested)
      throw SceneError(properties.location, "normalmap has no nested texture, expected one with the normals");
    normals = builder.texture(*nested);
  }
  return makeNormalMap(builder.nestedBsdf(properties, 0), normals, readPerturbation(properties));
}

}  // namespace odis::render
