#include "render/shape/sdf_grid.h"

#include "render/shape/surface_math.h"

namespace odis::render {
namespace {

Imath::M44d gridToWorld(const Affine& toWorld, const std::array<uint32_t, 3>& size) {
  const Vec3d x = toWorld.x / (size[0] - 1.0), y = toWorld.y / (size[1] - 1.0),
              z = toWorld.z / (size[2] - 1.0), &o = toWorld.origin;
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, o.x, o.y, o.z, 1};
}

// c[0] + c[1] t + c[2] t^2 + c[3] t^3.
double polynomial(const double c[4], double t) {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

// The first root in [0, end], on pieces between which the polynomial turns; false if there is none.
bool firstRoot(const double c[4], double end, double& root) {
  double nodes[4] = {0, end, end, end};
  int count = 1;
  // Zeros of the derivative, in order and without cancellation.
  const double a = 3 * c[3], b = 2 * c[2], discriminant = b * b - 4 * a * c[1];
  if (discriminant >= 0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double turns[2] = {a != 0 ? q / a : -1, q != 0 ? c[1] / q : -1};
    if (turns[0] > turns[1]) std::swap(turns[0], turns[1]);
    for (const double turn : turns)
      if (turn > 0 && turn < end) nodes[count++] = turn;
  }
  nodes[count] = end;
  for (int i = 0; i < count; ++i) {
    double low = nodes[i], high = nodes[i + 1], fLow = polynomial(c, low);
    const double fHigh = polynomial(c, high);
    if (fLow * fHigh > 0) continue;
    // Monotonous in between: bisection, down to the last bits of what is then rounded to single precision.
    for (int step = 0; step < 48; ++step) {
      const double middle = 0.5 * (low + high), f = polynomial(c, middle);
      if (fLow * f <= 0) {
        high = middle;
      } else {
        low = middle;
        fLow = f;
      }
    }
    root = high;
    return true;
  }
  return false;
}

}  // namespace

SdfGrid::SdfGrid(DistanceGrid grid, const Matrix4& toWorld, bool smooth)
    : m_grid(std::move(grid)),
      m_toWorld(toWorld),
      m_toGrid(gridToWorld(m_toWorld, m_grid.size).inverse()),
      m_smooth(smooth) {
  for (uint32_t z = 0; z + 1 < m_grid.size[2]; ++z)
    for (uint32_t y = 0; y + 1 < m_grid.size[1]; ++y)
      for (uint32_t x = 0; x + 1 < m_grid.size[0]; ++x)
        if (isCrossed({x, y, z})) m_cells.push_back({x, y, z});
}

bool SdfGrid::isCrossed(const Cell& cell) const {
  bool inside = false, outside = false;
  for (uint32_t i = 0; i < 8; ++i) {
    const float f = corner(cell[0] + (i & 1), cell[1] + (i >> 1 & 1), cell[2] + (i >> 2));
    inside |= f <= 0;
    outside |= f >= 0;
  }
  return inside && outside;
}

RTCGeometryTy* SdfGrid::makeGeometry(RTCDeviceTy* device) const {
  return makeUserGeometry(device, *this, unsigned(m_cells.size()));
}

Imath::Box3d SdfGrid::bounds(uint32_t cell) const {
  Imath::Box3d box;
  // A little more than the cell, so that nothing falls between two of them.
  constexpr double margin = 1e-5;
  for (uint32_t i = 0; i < 8; ++i) {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] =
          (m_cells[cell][axis] + ((i >> axis & 1) != 0 ? 1 + margin : -margin)) / (m_grid.size[axis] - 1.0);
    box.extendBy(m_toWorld.point(p));
  }
  return box;
}

bool SdfGrid::hit(uint32_t index, const PreciseRay& ray, double& t) const {
  const Cell& cell = m_cells[index];
  Vec3d origin, direction;
  m_toGrid.multVecMatrix(ray.origin, origin);
  m_toGrid.multDirMatrix(ray.direction, direction);
  origin -= Vec3d(cell[0], cell[1], cell[2]);
  // Where the ray is in the cell.
  double begin = std::max(ray.tMin, 0.0), end = ray.tMax;
  constexpr double margin = 1e-9;
  for (int axis = 0; axis < 3; ++axis) {
    double near = (-margin - origin[axis]) / direction[axis],
           far = (1 + margin - origin[axis]) / direction[axis];
    if (near > far) std::swap(near, far);
    if (direction[axis] == 0) {
      if (origin[axis] < -margin || origin[axis] > 1 + margin) return false;
      continue;
    }
    begin = std::max(begin, near);
    end = std::min(end, far);
  }
  if (!(begin <= end)) return false;

  // f = k0 + kx x + ky y + kz z + kxy x y + ... along the ray, which is a cubic polynomial.
  double f[8];
  for (uint32_t i = 0; i < 8; ++i)
    f[i] = corner(cell[0] + (i & 1), cell[1] + (i >> 1 & 1), cell[2] + (i >> 2));
  const double kx = f[1] - f[0], ky = f[2] - f[0], kz = f[4] - f[0], kxy = f[3] - f[2] - kx,
               kxz = f[5] - f[4] - kx, kyz = f[6] - f[4] - ky, kxyz = f[7] - f[6] - f[5] + f[4] - kxy;
  const Vec3d o = origin + direction * begin, &d = direction;
  const double c[4] = {f[0] + kx * o.x + ky * o.y + kz * o.z + kxy * o.x * o.y + kxz * o.x * o.z +
                           kyz * o.y * o.z + kxyz * o.x * o.y * o.z,
                       kx * d.x + ky * d.y + kz * d.z + kxy * (o.x * d.y + d.x * o.y) +
                           kxz * (o.x * d.z + d.x * o.z) + kyz * (o.y * d.z + d.y * o.z) +
                           kxyz * (o.x * o.y * d.z + o.x * d.y * o.z + d.x * o.y * o.z),
                       kxy * d.x * d.y + kxz * d.x * d.z + kyz * d.y * d.z +
                           kxyz * (o.x * d.y * d.z + d.x * o.y * d.z + d.x * d.y * o.z),
                       kxyz * d.x * d.y * d.z};
  double root;
  if (!firstRoot(c, std::min(end - begin, 1e30), root) || !ray.contains(begin + root)) return false;
  t = begin + root;
  return true;
}

double SdfGrid::value(const Vec3d& p) const {
  uint32_t first[3];
  double share[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double clamped = limited(p[axis], 0.0, m_grid.size[axis] - 1.0);
    first[axis] = std::min(uint32_t(clamped), m_grid.size[axis] - 2);
    share[axis] = clamped - first[axis];
  }
  double sum = 0;
  for (uint32_t i = 0; i < 8; ++i) {
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= (i >> axis & 1) != 0 ? share[axis] : 1 - share[axis];
    sum += weight * corner(first[0] + (i & 1), first[1] + (i >> 1 & 1), first[2] + (i >> 2));
  }
  return sum;
}

Vec3d SdfGrid::gradient(const Vec3d& p, const Cell& cell) const {
  Vec3d result;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d low = p, high = p;
    low[axis] = cell[axis];
    high[axis] = cell[axis] + 1.0;
    // In the unit cube, not in cells: cells need not be cubes.
    result[axis] = (value(high) - value(low)) * (m_grid.size[axis] - 1.0);
  }
  return result;
}

// Hansson-Soderlund et al. 2022, section 3.3: normals of the eight cells around, weighted by how near their
// middles are.
Vec3d SdfGrid::smoothNormal(const Vec3d& p) const {
  Vec3d sum(0, 0, 0);
  for (uint32_t i = 0; i < 8; ++i) {
    Cell cell;
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = limited(std::round(p[axis]), 0.0, m_grid.size[axis] - 1.0);
      const bool hasLow = middle >= 1, hasHigh = middle + 1 < m_grid.size[axis];
      const double share = !hasLow ? 1 : !hasHigh ? 0 : p[axis] - middle + 0.5;
      const bool high = (i >> axis & 1) != 0;
      weight *= high ? share : 1 - share;
      cell[axis] = uint32_t(middle) - (high ? 0 : 1);
    }
    if (weight > 0) sum += gradient(p, cell).normalized() * weight;
  }
  return sum;
}

bool SdfGrid::moveOntoSurface(const Cell& cell, double most, Vec3d& p) const {
  Vec3d nearest = p;
  for (int step = 0; step < 2; ++step) {  // of Newton's method
    Vec3d slope = gradient(nearest, cell);
    for (int axis = 0; axis < 3; ++axis) slope[axis] /= m_grid.size[axis] - 1.0;
    nearest -= slope * (value(nearest) / slope.dot(slope));
  }
  if (!((nearest - p).length() <= most)) return false;
  p = nearest;
  return true;
}

SurfacePoint SdfGrid::surfacePoint(const Ray& ray, const RawHit& hit) const {
  const Ray inObject = toObject(ray, hit);
  Vec3d p = Vec3d(inObject.origin) + Vec3d(inObject.direction) * double(hit.t);
  Vec3d inGrid, alongRay;
  m_toGrid.multVecMatrix(p, inGrid);
  m_toGrid.multDirMatrix(Vec3d(inObject.direction), alongRay);
  const Affine& m = m_toWorld;
  double error = positionError(maxAbs(Vec3(p)) + std::abs(hit.t) * maxAbs(inObject.direction));
  // t is rounded, so the point is moved onto the surface.
  if (moveOntoSurface(m_cells[hit.primitive], alongRay.length() * hit.t * 0x1p-22, inGrid)) {
    p = m.point({inGrid.x / (m_grid.size[0] - 1.0), inGrid.y / (m_grid.size[1] - 1.0),
                 inGrid.z / (m_grid.size[2] - 1.0)});
    error = preciseError(maxAbs(m.origin) + maxAbs(m.x) + maxAbs(m.y) + maxAbs(m.z));
  }
  // Normals turn by the inverse transposed: by the cross products of the axes.
  const auto normalToWorld = [&](const Vec3d& n) {
    const Vec3d turned = m.y.cross(m.z) * n.x + m.z.cross(m.x) * n.y + m.x.cross(m.y) * n.z;
    return m.mirrors() ? -turned : turned;
  };
  SurfacePoint at;
  at.shape = this;
  at.primitive = hit.primitive;
  at.p = Vec3(p);
  at.pError = float(error);
  at.ng =
      normalizeOr(normalToWorld(gradient(inGrid, m_cells[hit.primitive])), -normalize(inObject.direction));
  Vec3 n = at.ng;
  if (m_smooth) n = normalizeOr(normalToWorld(smoothNormal(inGrid)), at.ng);
  // Where cells disagree much, the smooth normal may be on the other side.
  if (!(dot(n, at.ng) > 0)) n = at.ng;
  at.shading = CoordinateFrame(n);
  toWorld(at, hit);
  return at;
}

PrimitiveExtent SdfGrid::extent(uint32_t cell) const {
  const Imath::Box3d box = bounds(cell);
  return {.min = roundedDown(box.min), .max = roundedUp(box.max)};
}

uint64_t SdfGrid::bytes() const {
  return sizeof(*this) + m_grid.values.size() * sizeof(float) + m_cells.size() * sizeof(Cell);
}

}  // namespace odis::render
