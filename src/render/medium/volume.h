// Quantities that vary from place to place: densities, albedos, the parameters of phase functions.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "render/math/vec.h"

namespace odis::render {

// An upper bound of a volume in each of the boxes that its domain is cut into, x fastest.
struct VolumeMaxima {
  std::array<uint32_t, 3> size{1, 1, 1};  // number of boxes along each axis
  std::vector<float> values;              // the greatest number of any channel
};

class Volume {
 public:
  virtual ~Volume() = default;

  // The value at a point in world space: a colour, or a grey.
  virtual Rgb rgb(const Vec3& p) const = 0;
  // The same as one number: the luminance of a grid's colour, the mean of other channels.
  virtual float scalar(const Vec3& p) const = 0;
  // The parameters of an SGGX distribution, Sxx, Syy, Szz, Sxy, Sxz, Syz, of volumes with six channels.
  virtual std::array<float, 6> six(const Vec3& /*p*/) const { return {}; }
  virtual int channels() const = 0;  // 1, 3 or 6

  // Upper and lower bounds of each channel over all points.
  virtual Rgb greatest() const = 0;
  virtual Rgb least() const = 0;
  bool isGrey() const { return channels() == 1; }
  // Whether the value is the same everywhere; then it is greatest().
  virtual bool isConstant() const { return false; }

  // World space to the unit cube that is the domain of a grid; nothing where the value holds everywhere.
  // Beyond the cube a grid has values, too, but a heterogeneous medium ends there, as in Mitsuba.
  virtual const Matrix4* toUnitCube() const { return nullptr; }
  // Upper bounds within the unit cube. Boxes are larger than voxels.
  virtual VolumeMaxima maxima() const { return {{1, 1, 1}, {maxComponent(greatest())}}; }
  virtual uint64_t bytes() const { return 0; }
};

using VolumePtr = std::shared_ptr<const Volume>;

}  // namespace odis::render
