// Volumes of signed distances, as far as the surface in them.
#include "memory_file.h"
#include "render/scene/scene.h"
#include "render/shape/sdf_grid.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace odis::render;
  const odis::fuzz::MemoryFile file(bytes, size);
  try {
    const auto shape = std::make_shared<SdfGrid>(readDistanceGrid(file.path(), {}), Matrix4(), size % 2 == 0);
    Scene scene;
    scene.addShape(shape);
    scene.finish();
    SurfacePoint at;
    for (const Vec3& direction : {Vec3(0, 0, -1), normalize(Vec3(0.1f, 0.2f, -1)), Vec3(0, 0, 1)})
      if (scene.intersect({Vec3(0.4f, 0.3f, direction.z > 0 ? -2 : 2), direction}, at) &&
          !(isFinite(at.ng) && isFinite(at.shading.n)))
        std::abort();
  } catch (const SceneError&) {
  }
  return 0;
}
