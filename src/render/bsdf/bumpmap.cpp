// bumpmap: perturbs the shading normal as if a texture of heights displaced the surface (Blinn 1978,
// "Simulation of Wrinkled Surfaces").
//
//   (nested texture)         the heights, under any name; only their differences count
//   scale                    number that multiplies the heights; 1
//   (nested bsdf)            one
//   flip_invalid_normals     whether to mirror a perturbed normal that faces away from the viewer; true
//   use_shadowing_function   whether to smooth the terminator; true
#include "render/bsdf/factories.h"
#include "render/bsdf/perturbed.h"

namespace odis::render {
namespace {

class BumpMap final : public Perturbed {
 public:
  BumpMap(BsdfPtr nested, TexturePtr heights, float scale, const PerturbationOptions& options)
      : Perturbed(std::move(nested), options), m_heights(std::move(heights)), m_scale(scale) {}

 private:
  Vec3 normal(const SurfacePoint& at) const override {
    const Vec2 slope = m_heights->gradient(at.uv) * m_scale;
    const Vec3& n = at.shading.n;
    // Derivatives of the displaced surface; that of the normal itself is ignored.
    const Vec3 dpdu = at.dpdu + n * (slope.x - dot(n, at.dpdu));
    const Vec3 dpdv = at.dpdv + n * (slope.y - dot(n, at.dpdv));
    const Vec3 bumped = cross(dpdu, dpdv);
    if (!(lengthSquared(bumped) > 0)) return {0, 0, 1};
    return at.shading.toLocal(normalize(dot(at.ng, bumped) < 0 ? -bumped : bumped));
  }

  Vec3 tangent(const SurfacePoint& at) const override { return at.shading.toLocal(at.dpdu); }

  TexturePtr m_heights;
  float m_scale;
};

}  // namespace

BsdfPtr makeBumpMap(BsdfPtr nested, TexturePtr heights, float scale, const PerturbationOptions& options) {
  return std::make_shared<BumpMap>(std::move(nested), std::move(heights), scale, options);
}

BsdfPtr makeBumpMap(const Properties& properties, Builder& builder) {
  const Properties* heights = properties.child("texture");
  if (!heights)
    throw SceneError(properties.location, "bumpmap has no nested texture, expected one with the heights");
  return makeBumpMap(builder.nestedBsdf(properties, 0), builder.texture(*heights),
                     properties.number("scale", kAnyNumber, 1.0f), readPerturbation(properties));
}

}  // namespace odis::render
