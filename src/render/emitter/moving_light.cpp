#include "render/emitter/moving_light.h"

namespace odis::render {

namespace {

// What the solid angle around a unit direction of the emitter's space is multiplied by on the way to the
// world, where the direction has the length `stretch` before it is made unit: of a linear map A around w
// |det A| / |A w|^3.
float solidAngleRatio(const Matrix4& toWorld, float stretch) {
  const Vec3 x = transformVector(toWorld, {1, 0, 0}), y = transformVector(toWorld, {0, 1, 0}),
             z = transformVector(toWorld, {0, 0, 1});
  return std::abs(dot(cross(x, y), z)) / (stretch * stretch * stretch);
}

Vec3 unitDirection(const Matrix4& matrix, const Vec3& direction) {
  return normalize(transformVector(matrix, direction));
}

// Whether the pose turns and scales, and does no more.
bool keepsAngles(const Pose& pose) {
  const auto& [x, y, z] = pose.stretch;
  const float tolerance = 1e-4f * x.x;
  for (const float skew : {y.x, z.x, z.y})
    if (std::abs(skew) > tolerance) return false;
  return std::abs(y.y - x.x) <= tolerance && std::abs(std::abs(z.z) - x.x) <= tolerance;
}

// The bounds at the moment of a pose, and how far from its centre of rotation they reach.
LightBounds boundsAt(const LightBounds& own, const Pose& pose, float& reach) {
  const Matrix4 toWorld = pose.matrix(), toInstance(Imath::M44d(toWorld).inverse());
  LightBounds moved = own;
  moved.min = Vec3(kInfinity);
  moved.max = Vec3(-kInfinity);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1 ? own.max : own.min).x, (corner & 2 ? own.max : own.min).y,
                 (corner & 4 ? own.max : own.min).z);
    const Vec3 q = transformPoint(toWorld, p);
    reach = std::max(reach, length(q - pose.translation));
    for (int axis = 0; axis < 3; ++axis) {
      moved.min[axis] = std::min(moved.min[axis], q[axis]);
      moved.max[axis] = std::max(moved.max[axis], q[axis]);
    }
  }
  moved.axis = normalize(transformNormal(toInstance, own.axis));
  if (!keepsAngles(pose)) moved.thetaO = kPi;
  return moved;
}

float angleBetween(const Pose& a, const Pose& b) {
  return 2 * std::acos(std::min(std::abs(a.rotation ^ b.rotation), 1.0f));
}

}  // namespace

EmitterSample sampleMoving(float time, const Emitter& emitter, uint32_t part, const Vec3& ref,
                           const Vec2& u) {
  const Placement placement = emitter.motion()->placementAt(time);
  EmitterSample sample = emitter.sample(part, transformPoint(placement.toInstance, ref), u);
  if (!(sample.pdf > 0)) return sample;
  const Vec3 direction = transformVector(placement.toWorld, sample.wi);
  const float stretch = length(direction);
  sample.wi = direction / stretch;
  sample.distance *= stretch;
  // The motion of delta lights keeps lengths, so that their irradiance is the same in both spaces.
  if (!sample.delta) sample.pdf /= solidAngleRatio(placement.toWorld, stretch);
  return sample;
}

float pdfOfMoving(const SurfaceEmitter& emitter, const Vec3& ref, const SurfacePoint& at) {
  const Placement placement = emitter.motion()->placementAt(at.time);
  SurfacePoint own = at;
  own.p = transformPoint(placement.toInstance, at.p);
  own.ng = normalize(transformNormal(placement.toWorld, at.ng));
  const Vec3 ownRef = transformPoint(placement.toInstance, ref);
  const float stretch = length(at.p - ref) / length(own.p - ownRef);
  return emitter.pdf(ownRef, own) / solidAngleRatio(placement.toWorld, stretch);
}

void viewMoving(float time, const EnvironmentEmitter& emitter, EnvironmentView& view) {
  // Environments turn and do no more.
  const Vec3 wi = view.wi;
  view.wi = unitDirection(emitter.motion()->placementAt(time).toInstance, wi);
  emitter.view({&view, 1});
  view.wi = wi;
}

LightBounds boundsWhileOpen(const Emitter& emitter, uint32_t part) {
  const LightBounds own = emitter.bounds(part);
  if (!emitter.motion()) return own;
  const std::vector<Pose>& poses = emitter.motion()->poses();
  float reach = 0, turn = 0;
  LightBounds all = boundsAt(own, poses.front(), reach);
  for (size_t i = 1; i < poses.size(); ++i) {
    all = merged(all, boundsAt(own, poses[i], reach));
    turn = std::max(turn, angleBetween(poses[i - 1], poses[i]));
  }
  // A point between two poses is not farther from the straight line between them than an arc of this angle
  // about the centre of rotation is long.
  all.min -= Vec3(reach * turn);
  all.max += Vec3(reach * turn);
  all.thetaO = std::min(all.thetaO + turn, kPi);
  // What emits by its area emits as much more as it is larger.
  const auto& [x, y, z] = poses.front().stretch;
  all.phi = own.phi * std::pow(std::abs(x.x * y.y * z.z), 2.0f / 3);
  return all;
}

}  // namespace odis::render
