#include "render/math/motion.h"

#include <ImathMatrixAlgo.h>

#include <cassert>

namespace odis::render {

namespace {

using Matrix3 = Imath::M33d;
using Vec3d = Imath::V3d;

template <class Matrix>
Vec3d row(const Matrix& m, int i) {
  return {m[i][0], m[i][1], m[i][2]};
}

struct PreciseKey {
  double time;
  Matrix3 stretch;
  Imath::Quatd rotation;
  Vec3d translation;

  Pose pose() const {
    Pose result;
    for (int i = 0; i < 3; ++i) result.stretch[i] = Vec3(row(stretch, i));
    result.rotation = Imath::Quatf(float(rotation.r), Vec3(rotation.v)).normalized();
    result.translation = Vec3(translation);
    return result;
  }
};

// Gram and Schmidt's orthogonal axes, from the image of x on, are the rotation.
PreciseKey takeApart(const KeyFrame& key) {
  const Vec3d rows[3] = {row(key.toWorld, 0), row(key.toWorld, 1), row(key.toWorld, 2)};
  const Vec3d x = rows[0].normalized(), y = (rows[1] - x * x.dot(rows[1])).normalized(), z = x.cross(y);
  PreciseKey result{key.time, Matrix3(0.0), {}, row(key.toWorld, 3)};
  for (int i = 0; i < 3; ++i) {
    result.stretch[i][0] = x.dot(rows[i]);
    if (i >= 1) result.stretch[i][1] = y.dot(rows[i]);
    if (i >= 2) result.stretch[i][2] = z.dot(rows[i]);
  }
  result.rotation =
      Imath::extractQuat(Imath::M44d(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, 0, 0, 0, 1))
          .normalized();
  return result;
}

// The key frame at a time between two.
PreciseKey between(const PreciseKey& a, const PreciseKey& b, double time) {
  const double t = std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0);
  return {time, a.stretch * (1 - t) + b.stretch * t,
          Imath::slerpShortestArc(a.rotation, b.rotation, t).normalized(),
          a.translation * (1 - t) + b.translation * t};
}

PreciseKey keyAt(const Animation& animation, double time) {
  size_t next = 0;
  while (next < animation.size() && animation[next].time < time) ++next;
  if (next == 0 || next == animation.size()) {
    PreciseKey key = takeApart(animation[next == 0 ? 0 : next - 1]);
    key.time = time;
    return key;
  }
  return between(takeApart(animation[next - 1]), takeApart(animation[next]), time);
}

// The key frames from one end of the shutter time to the other, with times as fractions of it.
std::vector<PreciseKey> keysWhileOpen(const Animation& animation, const Shutter& shutter) {
  std::vector<PreciseKey> keys{keyAt(animation, shutter.open)};
  for (const KeyFrame& key : animation)
    if (key.time > shutter.open && key.time < shutter.close) keys.push_back(takeApart(key));
  keys.push_back(keyAt(animation, shutter.close));
  for (PreciseKey& key : keys) key.time = (key.time - shutter.open) / (shutter.close - shutter.open);
  return keys;
}

// Whether an even grid of so many steps has a point at each key frame, and a different one for each.
bool fitGrid(const std::vector<PreciseKey>& keys, int steps) {
  double before = -1;
  for (const PreciseKey& key : keys) {
    const double place = key.time * steps, nearest = std::round(place);
    if (std::abs(place - nearest) > 1e-3 || nearest == before) return false;
    before = nearest;
  }
  return true;
}

// The fewest even steps that meet the key frames and turn little each.
int stepCount(const std::vector<PreciseKey>& keys) {
  double fewest = 1;
  for (size_t i = 1; i < keys.size(); ++i) {
    const double cosine = std::min(std::abs(keys[i - 1].rotation ^ keys[i].rotation), 1.0);
    fewest = std::max(fewest, 2 * std::acos(cosine) / kPoseTurn / (keys[i].time - keys[i - 1].time));
  }
  for (int steps = int(std::ceil(std::min(fewest, double(kMostPoseSteps)))); steps < kMostPoseSteps; ++steps)
    if (fitGrid(keys, steps)) return steps;
  return kMostPoseSteps;
}

}  // namespace

Matrix4 withoutScale(const Matrix4& matrix) {
  Matrix4 result = matrix;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis(matrix[i][0], matrix[i][1], matrix[i][2]);
    if (std::abs(lengthSquared(axis) - 1) <= 1e-3f) continue;
    for (int j = 0; j < 3; ++j) result[i][j] = axis[j] / length(axis);
  }
  return result;
}

Matrix4 Pose::matrix() const {
  // Rows are where the rotation takes the axes, in the order of its quaternion r + (i, j, k).
  const auto& [r, v] = rotation;
  const Vec3 x(1 - 2 * (v.y * v.y + v.z * v.z), 2 * (v.x * v.y + v.z * r), 2 * (v.x * v.z - v.y * r));
  const Vec3 y(2 * (v.x * v.y - v.z * r), 1 - 2 * (v.x * v.x + v.z * v.z), 2 * (v.y * v.z + v.x * r));
  const Vec3 z(2 * (v.x * v.z + v.y * r), 2 * (v.y * v.z - v.x * r), 1 - 2 * (v.x * v.x + v.y * v.y));
  Matrix4 result;
  for (int i = 0; i < 3; ++i) {
    const Vec3 row = x * stretch[i].x + y * stretch[i].y + z * stretch[i].z;
    for (int j = 0; j < 3; ++j) result[i][j] = row[j];
  }
  for (int j = 0; j < 3; ++j) result[3][j] = translation[j];
  return result;
}

Matrix4 Motion::matrixAt(const Animation& animation, double time) {
  return keyAt(animation, time).pose().matrix();
}

Motion::Motion(const Animation& animation, const Shutter& shutter) {
  const int steps = stepCount(keysWhileOpen(animation, shutter));
  for (int step = 0; step <= steps; ++step) {
    Pose pose = keyAt(animation, lerp(double(step) / steps, shutter.open, shutter.close)).pose();
    if (step > 0 && (m_poses.back().rotation ^ pose.rotation) < 0) pose.rotation = -pose.rotation;
    m_poses.push_back(pose);
  }
}

Matrix4 Motion::matrixAt(float time) const {
  const size_t steps = m_poses.size() - 1;
  assert(time >= 0 && time <= 1);
  const float place = time * float(steps);
  const size_t step = std::min(size_t(place), steps - 1);
  const float t = place - float(step);
  const Pose &a = m_poses[step], &b = m_poses[step + 1];
  Pose pose;
  for (int axis = 0; axis < 3; ++axis) pose.stretch[axis] = a.stretch[axis] * (1 - t) + b.stretch[axis] * t;
  pose.rotation = (a.rotation * (1 - t) + b.rotation * t).normalized();
  pose.translation = a.translation * (1 - t) + b.translation * t;
  return pose.matrix();
}

Placement Motion::placementAt(float time) const {
  const Matrix4 toWorld = matrixAt(time);
  return {toWorld, Matrix4(Imath::M44d(toWorld).inverse())};
}

bool Motion::isStill() const {
  const Matrix4 first = m_poses.front().matrix();
  float largest = 0;
  for (int i = 0; i < 16; ++i) largest = std::max(largest, std::abs(first[i / 4][i % 4]));
  for (const Pose& pose : m_poses)
    if (!first.equalWithAbsError(pose.matrix(), 1e-6f * largest)) return false;
  return true;
}

}  // namespace odis::render
