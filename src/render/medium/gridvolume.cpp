// gridvolume: values on a grid in the unit cube, interpolated.
//
//   filename        string                 of a volume of 1, 3 or 6 channels (".vol"), see volume_file.cpp
//   filter_type     trilinear (default), nearest
//   wrap_mode       clamp (default), repeat, mirror: beyond the cube
//   use_grid_bbox   boolean; false         whether the box in the file takes the place of the unit cube
//   to_world        transform              of the cube (or box)
//
// Values lie at the centres of voxels, as in Mitsuba 3. In scenes of Mitsuba 0.6 the first and the last lie
// on the border of the cube, and the box of the file is always used.
//
// `raw` of Mitsuba 3 speaks of spectra and means nothing here, nor does `accel`. `max_value` replaces the
// maximum that Mitsuba's tracking goes by. It is not needed: media go by the maximum of each part of the
// grid. If it is less than a value of the grid, where Mitsuba's images are wrong, a warning says so.
#include "render/medium/grid_volume.h"

#include <fmt/format.h>

#include "render/medium/volume_factories.h"
#include "render/shape/affine.h"
#include "render/shape/factories.h"

namespace odis::render {
namespace {

// Boxes of upper bounds have some 8 voxels a side, but there are no more than 64 of them along an axis.
constexpr int kVoxelsPerBox = 8, kMostBoxes = 64;
// Rounding may take a point this many voxels over the border of a box, far from the world's origin, and an
// interpolated value over those that it lies between by this part of it.
constexpr double kBoxMargin = 0.25;
constexpr float kValueMargin = 1e-6f;

template <class T, int kChannels>
class GridVolume final : public Volume {
 public:
  GridVolume(const VolumeFile& file, std::vector<T> values, const GridOptions& options)
      : m_values(std::move(values)),
        m_size(file.size),
        m_wrap(options.wrap),
        m_nearest(options.nearest),
        m_toUnitCube(options.toUnitCube) {
    Imath::M44d toVoxels = options.toUnitCube;
    for (int axis = 0; axis < 3; ++axis) {
      const int size = m_size[size_t(axis)];
      m_scale[axis] = options.onBorder ? size - 1 : size;
      m_offset[axis] = options.onBorder ? 0 : -0.5;
      for (int row = 0; row < 4; ++row) toVoxels[row][axis] *= m_scale[axis];
      toVoxels[3][axis] += m_offset[axis];
    }
    const Affine affine(toVoxels);
    m_origin = Vec3(affine.origin);
    m_x = Vec3(affine.x);
    m_y = Vec3(affine.y);
    m_z = Vec3(affine.z);
    m_least.fill(kInfinity);
    m_greatest.fill(-kInfinity);
    for (size_t i = 0; i < m_values.size(); ++i) {
      const float value = volumeNumber(m_values[i]);
      m_least[i % kChannels] = std::min(m_least[i % kChannels], value);
      m_greatest[i % kChannels] = std::max(m_greatest[i % kChannels], value);
    }
  }

  Rgb rgb(const Vec3& p) const override { return colour(lookUp(p)); }
  float scalar(const Vec3& p) const override {
    const Value value = lookUp(p);
    if constexpr (kChannels == 1) return value[0];
    if constexpr (kChannels == 3) return luminance(colour(value));
    float sum = 0;
    for (const float x : value) sum += x;
    return sum / kChannels;
  }
  std::array<float, 6> six(const Vec3& p) const override {
    if constexpr (kChannels == 6)
      return lookUp(p);
    else
      return Volume::six(p);
  }
  int channels() const override { return kChannels; }
  Rgb greatest() const override { return colour(m_greatest); }
  Rgb least() const override { return colour(m_least); }
  const Matrix4* toUnitCube() const override { return &m_toUnitCube; }
  VolumeMaxima maxima() const override;
  uint64_t bytes() const override { return m_values.size() * sizeof(T); }

 private:
  using Value = std::array<float, kChannels>;

  static Rgb colour(const Value& value) {
    if constexpr (kChannels == 1)
      return Rgb(value[0]);
    else
      return {value[0], value[1], value[2]};
  }
  // A coordinate in voxels, centres at whole numbers, as one that fits an int.
  static float tameVoxel(float x) { return limited(x, -1e9f, 1e9f); }
  const T* at(int x, int y, int z) const {
    return m_values.data() +
           ((size_t(z) * size_t(m_size[1]) + size_t(y)) * size_t(m_size[0]) + size_t(x)) * kChannels;
  }
  Value lookUp(const Vec3& p) const;
  // The first and the last voxel, not yet wrapped, that look-ups touch in a box.
  std::array<int, 2> touched(int axis, int box, int boxes) const;
  float greatestIn(const std::array<std::array<int, 2>, 3>& touched) const;

  std::vector<T> m_values;
  std::array<int, 3> m_size;
  Vec3 m_origin, m_x, m_y, m_z;  // from world space to voxels
  WrapMode m_wrap;
  bool m_nearest;
  Imath::V3d m_scale, m_offset;  // from the unit cube to voxels
  Matrix4 m_toUnitCube;
  Value m_least, m_greatest;
};

template <class T, int kChannels>
auto GridVolume<T, kChannels>::lookUp(const Vec3& p) const -> Value {
  const Vec3 voxel = m_origin + m_x * p.x + m_y * p.y + m_z * p.z;
  const float half = m_nearest ? 0.5f : 0.0f;
  int index[2][3];
  float t[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float x = tameVoxel(voxel[axis] + half);
    const int below = floorOf(x), size = m_size[size_t(axis)];
    t[axis] = x - float(below);
    index[0][axis] = wrap(below, size, m_wrap);
    index[1][axis] = m_nearest ? 0 : wrap(below + 1, size, m_wrap);
  }
  Value result;
  if (m_nearest) {
    const T* value = at(index[0][0], index[0][1], index[0][2]);
    for (int channel = 0; channel < kChannels; ++channel)
      result[size_t(channel)] = volumeNumber(value[channel]);
    return result;
  }
  const size_t x0 = size_t(index[0][0]) * kChannels, x1 = size_t(index[1][0]) * kChannels;
  const T* rows[4];
  for (int i = 0; i < 4; ++i) rows[i] = at(0, index[i & 1][1], index[i >> 1][2]);
  for (size_t channel = 0; channel < kChannels; ++channel) {
    float x[4];
    for (int i = 0; i < 4; ++i)
      x[i] = lerp(t[0], volumeNumber(rows[i][x0 + channel]), volumeNumber(rows[i][x1 + channel]));
    result[channel] = lerp(t[2], lerp(t[1], x[0], x[1]), lerp(t[1], x[2], x[3]));
  }
  return result;
}

template <class T, int kChannels>
std::array<int, 2> GridVolume<T, kChannels>::touched(int axis, int box, int boxes) const {
  const auto voxel = [&](int border) { return border * m_scale[axis] / boxes + m_offset[axis]; };
  const double first = voxel(box) - kBoxMargin, last = voxel(box + 1) + kBoxMargin;
  if (m_nearest) return {int(std::floor(first + 0.5)), int(std::floor(last + 0.5))};
  return {int(std::floor(first)), int(std::floor(last)) + 1};
}

template <class T, int kChannels>
float GridVolume<T, kChannels>::greatestIn(const std::array<std::array<int, 2>, 3>& touched) const {
  float result = -kInfinity;
  for (int k = touched[2][0]; k <= touched[2][1]; ++k)
    for (int j = touched[1][0]; j <= touched[1][1]; ++j) {
      const int y = wrap(j, m_size[1], m_wrap), z = wrap(k, m_size[2], m_wrap);
      for (int i = touched[0][0]; i <= touched[0][1]; ++i) {
        const T* value = at(wrap(i, m_size[0], m_wrap), y, z);
        for (int channel = 0; channel < kChannels; ++channel)
          result = std::max(result, volumeNumber(value[channel]));
      }
    }
  return result + std::abs(result) * kValueMargin;
}

template <class T, int kChannels>
VolumeMaxima GridVolume<T, kChannels>::maxima() const {
  VolumeMaxima result;
  std::array<int, 3> boxes{};
  for (size_t axis = 0; axis < 3; ++axis) {
    boxes[axis] = std::clamp((m_size[axis] - 1) / kVoxelsPerBox + 1, 1, kMostBoxes);
    result.size[axis] = uint32_t(boxes[axis]);
  }
  for (int z = 0; z < boxes[2]; ++z)
    for (int y = 0; y < boxes[1]; ++y)
      for (int x = 0; x < boxes[0]; ++x)
        result.values.push_back(
            greatestIn({touched(0, x, boxes[0]), touched(1, y, boxes[1]), touched(2, z, boxes[2])}));
  return result;
}

WrapMode readVolumeWrapMode(const Properties& node) {
  const std::string mode = node.word("wrap_mode", "clamp|repeat|mirror", "clamp");
  if (mode == "repeat") return WrapMode::repeat;
  return mode == "mirror" ? WrapMode::mirror : WrapMode::clamp;
}

// From the box of a file to the unit cube.
Imath::M44d fromBox(const VolumeFile& file, const SourceLocation& here) {
  Imath::M44d result;
  for (int axis = 0; axis < 3; ++axis) {
    const double least = file.boxMin[axis], edge = file.boxMax[axis] - least;
    if (!(edge > 0) || !std::isfinite(1 / edge) || !std::isfinite(least / edge))
      throw SceneError(here, fmt::format("found a box from {}, {}, {} to {}, {}, {}, expected one that has a "
                                         "volume",
                                         file.boxMin.x, file.boxMin.y, file.boxMin.z, file.boxMax.x,
                                         file.boxMax.y, file.boxMax.z));
    result[axis][axis] = 1 / edge;
    result[3][axis] = -least / edge;
  }
  return result;
}

}  // namespace

VolumePtr makeGrid(VolumeFile file, const GridOptions& options) {
  return std::visit(
      [&]<class T>(std::vector<T>& values) -> VolumePtr {
        if (file.channels == 1) return std::make_shared<GridVolume<T, 1>>(file, std::move(values), options);
        if (file.channels == 3) return std::make_shared<GridVolume<T, 3>>(file, std::move(values), options);
        return std::make_shared<GridVolume<T, 6>>(file, std::move(values), options);
      },
      file.values);
}

VolumePtr makeGridVolume(const Properties& node, Builder& builder) {
  GridOptions options;
  options.wrap = readVolumeWrapMode(node);
  options.nearest = node.word("filter_type", "trilinear|nearest", "trilinear") == "nearest";
  options.onBorder = node.before2;
  options.toUnitCube = readToWorld(node).inverse();
  const bool useBox = node.boolean("use_grid_bbox", node.before2);
  node.boolean("raw", false);
  const std::optional<float> given = node.optionalNumber("max_value", kAnyNumber);

  const SourceLocation& at = node.placeOf("filename");
  const std::string path = builder.resolvePath(node.string("filename"), at);
  VolumeFile file = builder.volumeFile(node, path, at);
  if (useBox) options.toUnitCube = options.toUnitCube * fromBox(file, {path, 0, 0});
  VolumePtr made = makeGrid(std::move(file), options);
  const float greatest = maxComponent(made->greatest());
  if (given && *given < greatest)
    builder.warn(
        node.placeOf("max_value"),
        fmt::format("'max_value' is {:.6g}, but the grid holds {:.6g}, which is drawn", *given, greatest));
  return made;
}

}  // namespace odis::render
