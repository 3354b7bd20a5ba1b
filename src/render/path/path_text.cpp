#include "render/path/path_text.h"

#include <fmt/format.h>

namespace odis::render {

std::string pathText(const Path& path, std::span<const PathVertex> vertices) {
  std::string text =
      fmt::format("radiance {:.6g} {:.6g} {:.6g}\n", path.radiance.x, path.radiance.y, path.radiance.z);
  for (const PathVertex& v : vertices)
    text += fmt::format(
        "  vertex {}: p ({:.5g} {:.5g} {:.5g}) n ({:.3f} {:.3f} {:.3f}) wi ({:.3f} {:.3f} {:.3f}){} pdf "
        "{:.4g} weight "
        "({:.4g} {:.4g} {:.4g}) direct ({:.4g} {:.4g} {:.4g}) arriving ({:.4g} {:.4g} {:.4g}) roughness "
        "{:.3g} next at "
        "{:.5g}\n",
        v.depth, v.position.x, v.position.y, v.position.z, v.normal.x, v.normal.y, v.normal.z, v.wi.x, v.wi.y,
        v.wi.z, v.discrete ? " (delta)" : "", v.pdf, v.weight.x, v.weight.y, v.weight.z, v.direct.x,
        v.direct.y, v.direct.z, v.radiance.x, v.radiance.y, v.radiance.z, v.roughness, v.distance);
  return text;
}

}  // namespace odis::render
