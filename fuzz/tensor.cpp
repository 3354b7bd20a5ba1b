// Tensor files of measured surfaces, as far as their BSDFs and some directions.
#include "memory_file.h"
#include "render/bsdf/factories.h"

namespace {

using namespace odis::render;

void scatter(const Bsdf& bsdf) {
  for (const float z : {1.0f, 0.5f, 1e-3f}) {
    const Vec3 wo = normalize(Vec3(1 - z, 0.1f, z));
    const BsdfSample sample = bsdf.sample({}, wo, 0.5f, {0.3f, 0.6f});
    if (std::isnan(sample.weight.x) || std::isnan(sample.pdf)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const odis::fuzz::MemoryFile file(bytes, size);
  Properties properties;
  properties.tag = "bsdf";
  properties.parameters["filename"].value = file.path();
  properties.parameters["wavelength"].value = 560.0;
  Warnings warnings;
  for (const BsdfFactory factory : {makeMeasured, makeMeasuredPolarized}) {
    Builder builder(warnings);
    try {
      scatter(*factory(properties, builder));
    } catch (const SceneError&) {
    }
  }
  return 0;
}
