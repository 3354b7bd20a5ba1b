// A volume with the same value everywhere: what a colour or a number in place of a volume means.
#pragma once

#include "render/medium/volume.h"

namespace odis::render {

class ConstantVolume final : public Volume {
 public:
  explicit ConstantVolume(const Rgb& value)
      : m_value(value), m_grey(value.x == value.y && value.y == value.z) {}

  Rgb rgb(const Vec3&) const override { return m_value; }
  float scalar(const Vec3&) const override { return m_grey ? m_value.x : average(m_value); }
  int channels() const override { return m_grey ? 1 : 3; }
  Rgb greatest() const override { return m_value; }
  Rgb least() const override { return m_value; }
  bool isConstant() const override { return true; }

 private:
  Rgb m_value;
  bool m_grey;
};

}  // namespace odis::render
