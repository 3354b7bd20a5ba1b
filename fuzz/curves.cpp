// Text files of curves, as far as the acceleration structure over them.
#include "render/shape/curves.h"
#include "memory_file.h"
#include "render/scene/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace odis::render;
  const odis::fuzz::MemoryFile file(bytes, size);
  for (const CurveBasis basis : {CurveBasis::linear, CurveBasis::bspline}) try {
      CurveData data = readCurves(file.path(), {}, Matrix4(), basis == CurveBasis::linear ? 2 : 4);
      Scene scene;
      scene.addShape(std::make_shared<Curves>(std::move(data), basis));
      scene.finish();
      SurfacePoint at;
      if (scene.intersect({{0.1f, 0.2f, 9}, {0, 0, -1}}, at) && !isFinite(at.ng)) std::abort();
    } catch (const SceneError&) {
    }
  return 0;
}
