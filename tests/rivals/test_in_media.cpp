// Rivals in participating media: they have the expectation of path tracing.
#include "integrator/foggy_room.h"
#include "integrator/same_expectation.h"
#include "render/rivals/open_pgl.h"

namespace odis::render {
namespace {

class RivalInFog : public test::AgainstPath<test::FoggyRoom> {
 protected:
  static RenderOptions rivalOptions(IntegratorKind kind) {
    RenderOptions options = guidedOptions();
    options.integrator = kind;
    options.spp = 10;  // enough for some iterations
    return options;
  }
};
constexpr int kTestsInFog = 3;

TEST_F(RivalInFog, OpenPgl) {
  if (!hasOpenPgl()) GTEST_SKIP() << "this build has no Open PGL";
  expectUnbiased(rivalOptions(IntegratorKind::openpgl), 192, kTestsInFog);
}

TEST_F(RivalInFog, Ppg) {
  for (const PpgOptions& version : {PpgOptions(), PpgOptions::firstPublished()}) {
    RenderOptions options = rivalOptions(IntegratorKind::ppg);
    options.ppg = version;
    expectUnbiased(options, 192, kTestsInFog);
  }
}

}  // namespace
}  // namespace odis::render
