// The interfaces of light sources. Directions `wi` are unit, in world space, from the lit point towards the
// light.
#pragma once

#include <memory>
#include <span>

#include "render/emitter/light_bounds.h"
#include "render/math/columns.h"
#include "render/math/motion.h"
#include "render/math/surface_point.h"

namespace odis::render {

struct EmitterSample {
  Vec3 wi{0, 0, 1};
  float distance = 0;     // to the sampled point; kInfinity for the environment
  Rgb radiance{0, 0, 0};  // arriving from there, unoccluded; for delta lights the irradiance that the light
                          // gives a surface facing it (W/m^2)
  float pdf = 0;          // solid angle; 1 for delta lights; 0 if nothing could be sampled
  bool delta = false;     // point, spot, directional: cannot be hit, so the MIS weight is one
};

// What a sample of a light is drawn with.
struct LightDraw {
  uint32_t part;
  Vec3 ref;  // the lit point
  Vec2 u;    // uniform in [0, 1)^2
};

struct LightTriangle;  // see light_triangles.h
struct LightSphere;    // see light_spheres.h

class Emitter {
 public:
  virtual ~Emitter() = default;

  // Into how many parts the emitter falls that are chosen one by one, as the triangles of a mesh; 0 if it is
  // infinitely far away, when part 0 is all of it.
  virtual uint32_t partCount() const { return 0; }
  // Where a part is and where it shines; only of emitters with parts.
  virtual LightBounds bounds(uint32_t /*part*/) const { return {}; }
  // Samples light arriving at `ref` from one part.
  virtual EmitterSample sample(uint32_t part, const Vec3& ref, const Vec2& u) const = 0;
  // The triangle that sample() draws from a part and, in `u`, the numbers that draw a point of it. Null for
  // emitters that are not flat triangles that shine evenly.
  virtual const LightTriangle* drawTriangle(uint32_t /*part*/, Vec2& /*u*/) const { return nullptr; }
  // The sphere that sample() draws points of. Null for emitters that are not spheres that shine evenly
  // outwards.
  virtual const LightSphere* sphere() const { return nullptr; }
  // sample() for each of up to kLanes draws, for those that read much from memory.
  virtual void sampleEach(std::span<const LightDraw> draws, std::span<EmitterSample> samples) const {
    for (size_t i = 0; i < draws.size(); ++i) samples[i] = sample(draws[i].part, draws[i].ref, draws[i].u);
  }
  // What an emitter infinitely far away gives a surface, on average over all ways to face (W/m^2, average
  // over channels), for choosing among lights. Approximate is fine.
  virtual float meanIrradiance() const { return 0; }
  // Of an emitter infinitely far away: whether invert() knows the numbers that sample() takes to a direction.
  virtual bool invertible() const { return false; }
  // These numbers, but for rounding; any where sample() never goes.
  virtual Vec2 invert(const Vec3& /*wi*/) const { return {0, 0}; }

  // How it moves, null if it doesn't. All else that an emitter says is then said in its own space, which the
  // motion takes to the world: moving_light.h asks it for a time.
  const Motion* motion() const { return m_motion.get(); }
  void setMotion(std::shared_ptr<const Motion> motion) { m_motion = std::move(motion); }

  // The emitter's place among those of its scene.
  uint32_t index() const { return m_index; }
  void setIndex(uint32_t index) { m_index = index; }

 private:
  std::shared_ptr<const Motion> m_motion;
  uint32_t m_index = 0;
};

// Light leaving the surface of a shape. One emitter a shape.
class SurfaceEmitter : public Emitter {
 public:
  // Radiance leaving `at` in direction `wo` (world space, away from the surface); zero on the back.
  virtual Rgb radiance(const SurfacePoint& at, const Vec3& wo) const = 0;
  // The part that a point of the shape belongs to.
  virtual uint32_t part(const SurfacePoint& at) const = 0;
  // Solid-angle density with which sample(part(at), ref) gives the direction from `ref` to `at`.
  virtual float pdf(const Vec3& ref, const SurfacePoint& at) const = 0;
};

// What an environment shows in a direction.
struct EnvironmentView {
  Vec3 wi;
  bool asksPdf = false;      // whether pdf is asked for
  bool asksNumbers = false;  // and, of those that are invertible, u
  Rgb radiance{0, 0, 0};
  float pdf = 0;  // EnvironmentEmitter::pdf()
  Vec2 u{0, 0};   // Emitter::invert()
};

// Light from infinitely far away: environment maps, constant, sky, sun disc.
class EnvironmentEmitter : public Emitter {
 public:
  // Radiance arriving from direction `wi`.
  virtual Rgb radiance(const Vec3& wi) const = 0;
  // Solid-angle density with which sample() gives wi, wherever the lit point is.
  virtual float pdf(const Vec3& wi) const = 0;
  // What is asked for of each of up to kLanes directions.
  virtual void view(std::span<EnvironmentView> views) const {
    for (EnvironmentView& view : views) {
      view.radiance = radiance(view.wi);
      if (view.asksPdf) view.pdf = pdf(view.wi);
      if (view.asksNumbers) view.u = invert(view.wi);
    }
  }
};

using EmitterPtr = std::shared_ptr<Emitter>;

}  // namespace odis::render
