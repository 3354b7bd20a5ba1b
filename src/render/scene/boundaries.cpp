#include "render/scene/boundaries.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_map>

namespace odis::render {
namespace {

// How near to each other two openings are that close each other, in parts of the size of what they bound.
constexpr float kSamePlace = 1e-4f;

// Points by the cells of a grid that they lie in.
class PointGrid {
 public:
  PointGrid(const Vec3& origin, float cell) : m_origin(origin), m_cell(cell) {}

  void add(const Vec3& p, size_t index) { m_cells[keyOf(cellOf(p))].push_back(index); }
  // Calls seen(index) for all points in the cell of `p` and those around it.
  template <class Seen>
  void around(const Vec3& p, const Seen& seen) const {
    const std::array<int64_t, 3> cell = cellOf(p);
    for (int64_t z = -1; z <= 1; ++z)
      for (int64_t y = -1; y <= 1; ++y)
        for (int64_t x = -1; x <= 1; ++x) {
          const auto found = m_cells.find(keyOf({cell[0] + x, cell[1] + y, cell[2] + z}));
          if (found == m_cells.end()) continue;
          for (const size_t index : found->second) seen(index);
        }
  }

 private:
  std::array<int64_t, 3> cellOf(const Vec3& p) const {
    std::array<int64_t, 3> cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[size_t(axis)] = int64_t(std::floor(limited((p[axis] - m_origin[axis]) / m_cell, 0.0f, 1e6f)));
    return cell;
  }
  static uint64_t keyOf(const std::array<int64_t, 3>& cell) {
    constexpr uint64_t kMask = (uint64_t(1) << 21) - 1;
    const auto part = [&](size_t axis) { return (uint64_t(cell[axis]) & kMask) << (21 * axis); };
    return part(0) | part(1) | part(2);
  }

  Vec3 m_origin;
  float m_cell;
  std::unordered_map<uint64_t, std::vector<size_t>> m_cells;
};

}  // namespace

void Boundaries::add(const Shape& shape, const Motion* motion, const SourceLocation& at, const void* key) {
  std::vector<Vec3> openings = shape.openings();
  if (openings.empty()) return;
  if (motion) {
    const Matrix4 toWorld = motion->matrixAt(0);
    for (Vec3& p : openings) p = transformPoint(toWorld, p);
  }
  auto frame = std::find_if(m_frames.begin(), m_frames.end(), [&](const Frame& f) { return f.key == key; });
  if (frame == m_frames.end()) frame = m_frames.insert(frame, Frame{key, {}, {}});
  for (const Vec3& p : openings) frame->openings.push_back({p, frame->shapes.size()});
  frame->shapes.push_back(at);
}

void Boundaries::warn(Warnings& warnings) const {
  for (const Frame& frame : m_frames) warn(frame, warnings);
}

void Boundaries::warn(const Frame& frame, Warnings& warnings) {
  Vec3 low(kInfinity), high(-kInfinity);
  for (const Opening& opening : frame.openings)
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], opening.p[axis]);
      high[axis] = std::max(high[axis], opening.p[axis]);
    }
  const float near = std::max(maxComponent(high - low), 1e-30f) * kSamePlace;
  PointGrid grid(low, near);
  for (size_t i = 0; i < frame.openings.size(); ++i) grid.add(frame.openings[i].p, i);
  std::vector<bool> told(frame.shapes.size(), false);
  for (const Opening& opening : frame.openings) {
    if (told[opening.shape]) continue;
    bool closed = false;
    grid.around(opening.p, [&](size_t other) {
      const Opening& facing = frame.openings[other];
      closed |= facing.shape != opening.shape && lengthSquared(facing.p - opening.p) <= sqr(near);
    });
    if (closed) continue;
    told[opening.shape] = true;
    warnings.add(frame.shapes[opening.shape],
                 fmt::format("the boundary of a medium is not closed near ({:.6g}, {:.6g}, {:.6g}): rays "
                             "that pass the opening keep the medium they are in",
                             opening.p.x, opening.p.y, opening.p.z),
                 Effect::same);
  }
}

}  // namespace odis::render
