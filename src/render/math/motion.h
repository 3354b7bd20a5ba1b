// How something moves while the shutter is open: key frames taken apart and interpolated.
//
// Each key frame is a stretch, then a rotation, then a translation. Between two, translation and stretch are
// linear in time and the rotation goes the shorter way at constant speed (Shoemake 1985, "Animating Rotation
// with Quaternion Curves"). Before the first and after the last nothing moves.
#pragma once

#include <ImathQuat.h>

#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// When the sensor sees the scene, in the unit of the scene's key frames.
struct Shutter {
  double open = 0, close = 0;

  bool closed() const { return !(close > open); }
};

struct KeyFrame {
  double time;
  Matrix4 toWorld;
};

// One or more, later ones after earlier ones. All are affine and have an inverse, and either all or none
// mirror.
using Animation = std::vector<KeyFrame>;

// The transform with axes of unit length.
Matrix4 withoutScale(const Matrix4& matrix);

// A transform taken apart: the rows of `stretch`, a lower triangular matrix that multiplies row vectors, are
// where it takes the axes. Only its last diagonal element may be negative.
struct Pose {
  Vec3 stretch[3];
  Imath::Quatf rotation;  // unit
  Vec3 translation;

  Matrix4 matrix() const;
};

// A place and the way back.
struct Placement {
  Matrix4 toWorld, toInstance;
};

class Motion {
 public:
  // Where that is at a time, in the unit of the key frames, for what doesn't move.
  static Matrix4 matrixAt(const Animation& animation, double time);

  // The shutter must not be closed.
  Motion(const Animation& animation, const Shutter& shutter);

  // Times from here on are fractions of the time that the shutter is open.
  Matrix4 matrixAt(float time) const;
  Placement placementAt(float time) const;
  // Whether nothing moves after all.
  bool isStill() const;

  // Evenly spread over the time, two or more, and close enough together to be interpolated linearly,
  // quaternions over the length of the result: which is what Embree does with them as well. Key frames are
  // among them if they lie on a grid of at most kMostPoseSteps steps; else the turn at a key frame takes as
  // long as a step.
  const std::vector<Pose>& poses() const { return m_poses; }

 private:
  std::vector<Pose> m_poses;
};

// Embree's limit.
inline constexpr int kMostPoseSteps = 128;
// The largest angle between rotations of neighbouring poses, in radians, as far as that many steps allow.
inline constexpr double kPoseTurn = 3 * std::numbers::pi / 180;

}  // namespace odis::render
