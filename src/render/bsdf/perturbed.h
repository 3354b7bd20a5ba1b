// BSDFs whose shading frame a texture perturbs: bump maps and normal maps.
#pragma once

#include "render/bsdf/bsdf.h"
#include "render/texture/texture.h"
#include "render/xml/properties.h"

namespace odis::render {

struct PerturbationOptions {
  bool flipInvalidNormals = true;  // mirror a perturbed normal that faces away from wo about the original one
  bool useShadowing = true;        // smooth the terminator (Estevez et al. 2019)
};
PerturbationOptions readPerturbation(const Properties& properties);

class Perturbed : public Bsdf {
 public:
  Perturbed(BsdfPtr nested, const PerturbationOptions& options);

  BsdfSample sample(const SurfacePoint& at, const Vec3& wo, float uLobe, const Vec2& u) const final;
  BsdfValue evaluate(const SurfacePoint& at, const Vec3& wo, const Vec3& wi) const final;
  Rgb nullTransmission(const SurfacePoint& at, const Vec3& wo) const override;
  float guidableProbability(const SurfacePoint& at, const Vec3& wo) const final;
  BsdfFeatures features(const SurfacePoint& at, const Vec3& wo) const final;

 private:
  struct Turned {
    CoordinateFrame frame;  // of the perturbed surface, in coordinates of the original shading frame
    SurfacePoint at;        // with the perturbed shading frame
    float alpha2;           // squared roughness of the terminator's shadowing
  };
  // The unit normal that the texture asks for, in the original shading frame.
  virtual Vec3 normal(const SurfacePoint& at) const = 0;
  // The local tangent that the perturbed frame's s should follow.
  virtual Vec3 tangent(const SurfacePoint& at) const = 0;

  Turned turn(const SurfacePoint& at, const Vec3& wo) const;
  float shadowing(const Turned& turned, const Vec3& wi) const;

  BsdfPtr m_nested;
  PerturbationOptions m_options;
};

// The height of the surface above its mesh is `scale` times the texture's scalar, in world units.
BsdfPtr makeBumpMap(BsdfPtr nested, TexturePtr heights, float scale, const PerturbationOptions& options = {});
// The texture's rgb is (n + 1) / 2 for the normal n in the shading frame.
BsdfPtr makeNormalMap(BsdfPtr nested, TexturePtr normals, const PerturbationOptions& options = {});

}  // namespace odis::render
