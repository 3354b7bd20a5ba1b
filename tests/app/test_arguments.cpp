#include <gtest/gtest.h>

#include "command.h"
#include "compare_arguments.h"
#include "output.h"
#include "render_arguments.h"
#include "suggest.h"

using namespace odis::app;
using namespace odis::render;

namespace {

TEST(Arguments, Resolution) {
  EXPECT_EQ(parseResolution("640x360"), Vec2i(640, 360));
  for (const char* wrong : {"", "640", "640x", "x360", "640X360", "640x0", "-1x5", "640x360x", "640,360",
                            "1e3x5", "99999999999x5"})
    EXPECT_THROW(parseResolution(wrong), UsageError) << wrong;
}

TEST(Arguments, CropWindow) {
  const Crop crop = parseCrop("1,2,30,40");
  EXPECT_EQ(crop.x, 1);
  EXPECT_EQ(crop.y, 2);
  EXPECT_EQ(crop.width, 30);
  EXPECT_EQ(crop.height, 40);
  for (const char* wrong : {"", "1,2,3", "1,2,3,0", "-1,2,3,4", "1,2,3,4,5", "1;2;3;4", "1,2,3,4x"})
    EXPECT_THROW(parseCrop(wrong), UsageError) << wrong;
}

TEST(Arguments, Define) {
  EXPECT_EQ(parseDefine("a=b=c"), std::make_pair(std::string("a"), std::string("b=c")));
  EXPECT_EQ(parseDefine("a=").second, "");
  EXPECT_THROW(parseDefine("a"), UsageError);
  EXPECT_THROW(parseDefine("=a"), UsageError);
}

TEST(Arguments, Layers) {
  const odis::app::Layers some = parseLayers("albedo,depth");
  EXPECT_TRUE(some.albedo && some.depth);
  EXPECT_FALSE(some.normal || some.position || some.roughness);
  EXPECT_TRUE(parseLayers("all").roughness);
  EXPECT_FALSE(parseLayers("").any());
  EXPECT_THROW(parseLayers("albedo,normals"), UsageError);
}

TEST(Arguments, MethodOfAComparison) {
  const RenderOptions options =
      parseMethod("--integrator odis --set guide-bounces=3 --set pilot-spp=0.25 --sampler independent");
  EXPECT_EQ(options.integrator, IntegratorKind::odis);
  EXPECT_EQ(options.setting("guide-bounces"), "3");
  EXPECT_EQ(options.setting("pilot-spp"), "0.25");
  EXPECT_EQ(options.sampler, SamplerKind::independent);
  EXPECT_EQ(parseMethod("--integrator path").integrator, IntegratorKind::path);
  EXPECT_THROW(parseMethod("--integrator bdpt"), UsageError);
  EXPECT_THROW(parseMethod("--guide-bounce 3"), UsageError);
  EXPECT_THROW(parseMethod("--set guide-bounce=3"), UsageError);
}

TEST(Arguments, PracticalPathGuiding) {
  const RenderOptions
      improved = parseMethod("--integrator ppg"),
      first = parseMethod("--integrator ppg --set ppg=2017"),
      mixed = parseMethod(
          "--integrator ppg --set ppg=2017 --set ppg-bsdf-fraction=learned --set ppg-spatial=box");
  EXPECT_EQ(improved.integrator, IntegratorKind::ppg);
  EXPECT_EQ(improved.ppg.bsdfFraction, PpgOptions::BsdfFraction::learned);
  EXPECT_EQ(improved.ppg.threshold, 4000);
  EXPECT_EQ(first.ppg.combine, PpgOptions::Combine::last);
  EXPECT_EQ(first.ppg.threshold, 12000);
  EXPECT_EQ(mixed.ppg.bsdfFraction, PpgOptions::BsdfFraction::learned);
  EXPECT_EQ(mixed.ppg.spatial, PpgOptions::Spatial::box);
  EXPECT_EQ(mixed.ppg.directional, QuadtreeFilter::nearest);
  EXPECT_THROW(parseMethod("--set ppg=2018"), UsageError);
  EXPECT_THROW(parseMethod("--set ppg-bsdf-fraction=0.5"), UsageError);
}

TEST(Arguments, SampleCountsRise) {
  EXPECT_EQ(parseSampleCounts("4"), std::vector<int>{4});
  EXPECT_EQ(parseSampleCounts("1,2,16777216"), (std::vector<int>{1, 2, 16777216}));
  for (const char* wrong :
       {"", ",", "4,", ",4", "4,,8", "0", "-4", "4,4", "8,4", "4 8", "4, 8", "4.0", "x", "16777217", "1e2"})
    EXPECT_THROW(parseSampleCounts(wrong), UsageError) << wrong;
}

TEST(Arguments, Resampling) {
  const RenderOptions options =
      parseMethod("--integrator restir --set restir-neighbours=7 --set restir-radius=9.5");
  EXPECT_EQ(options.integrator, IntegratorKind::restir);
  EXPECT_EQ(options.restir.neighbours, 7);
  EXPECT_EQ(options.restir.radius, 9.5f);
  EXPECT_THROW(parseMethod("--set restir-neighbours=-1"), UsageError);
}

TEST(Suggest, FindsTheNearestWord) {
  EXPECT_EQ(nearest("--ssp", {"--spp", "--seed", "--stats"}), "--spp");
  EXPECT_EQ(nearest("rendr", {"render", "metrics"}), "render");
  EXPECT_EQ(nearest("--quantum", {"--spp", "--seed"}), "");
}

TEST(Text, ForPeople) {
  EXPECT_EQ(durationText(0.0123), "12 ms");
  EXPECT_EQ(durationText(4.25), "4.2 s");
  EXPECT_EQ(durationText(65), "1 min 05 s");
  EXPECT_EQ(durationText(3725), "1 h 02 min");
  EXPECT_EQ(bytesText(512), "512 B");
  EXPECT_EQ(bytesText(1536), "1.5 KiB");
  EXPECT_EQ(bytesText(3.0 * 1024 * 1024 * 1024), "3.0 GiB");
}

}  // namespace
