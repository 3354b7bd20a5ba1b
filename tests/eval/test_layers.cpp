// What `odis image` does with layers and differences.
#include "eval/layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/difference.h"
#include "eval/metrics.h"
#include "support/temporary_folder.h"

using namespace odis::eval;
using odis::render::Rgb;

namespace {

LayeredImage layered(std::map<std::string, std::vector<float>> channels) {
  LayeredImage image;
  image.window = {2, 1, 0, 0, 2, 1};
  image.channels = std::move(channels);
  return image;
}

TEST(Layers, SummarizesFiniteValues) {
  const ChannelSummary s = summarizeChannel({2, NAN, -1, 5, INFINITY});
  EXPECT_EQ(s.least, -1);
  EXPECT_EQ(s.most, 5);
  EXPECT_EQ(s.mean, 2);
  EXPECT_EQ(s.nonFinite, 2u);
  EXPECT_EQ(summarizeChannel({NAN}).mean, 0);
}

TEST(Layers, FindsColours) {
  const LayeredImage image = layered({{"R", {1, 2}},
                                      {"G", {3, 4}},
                                      {"B", {5, 6}},
                                      {"N.X", {7, 8}},
                                      {"N.Y", {9, 10}},
                                      {"N.Z", {11, 12}},
                                      {"depth.Z", {13, 14}}});
  EXPECT_EQ(layerColor(image, "").pixels[1], Rgb(2, 4, 6));
  EXPECT_EQ(layerColor(image, "N").pixels[0], Rgb(7, 9, 11));
  EXPECT_EQ(layerColor(image, "depth").pixels[0], Rgb(13));
  EXPECT_EQ(layerNames(image), (std::vector<std::string>{"", "N", "depth"}));
  try {
    layerColor(image, "albedo");
    FAIL();
  } catch (const ImageError& error) {
    EXPECT_NE(std::string(error.what()).find("\"\", N, depth"), std::string::npos) << error.what();
  }
}

// Two independent images: the variance of their mean is the sum over 4, its root for standard errors.
TEST(Layers, Average) {
  const LayeredImage a = layered(
                         {{"R", {1, 2}}, {"variance.R", {4, 4}}, {"stderr.R", {3, 3}}, {"Z", {1, 1}}}),
                     b = layered({{"R", {3, 4}}, {"variance.R", {8, 0}}, {"stderr.R", {4, 4}}});
  const LayeredImage mean = average({a, b});
  EXPECT_EQ(mean.channels.at("R"), (std::vector<float>{2, 3}));
  EXPECT_EQ(mean.channels.at("variance.R"), (std::vector<float>{3, 1}));
  EXPECT_EQ(mean.channels.at("stderr.R"), (std::vector<float>{2.5f, 2.5f}));
  EXPECT_EQ(mean.channels.count("Z"), 0u);  // only one has it
  LayeredImage moved = b;
  moved.window.x = 1;
  EXPECT_THROW(average({a, moved}), ImageError);
  EXPECT_THROW(average({}), std::invalid_argument);
}

TEST(Layers, MergeKeepsChannelsApart) {
  const LayeredImage a = layered({{"R", {1, 2}}}), b = layered({{"R", {3, 4}}, {"albedo.R", {5, 6}}});
  const LayeredImage both = merge({{"", a}, {"odis", b}});
  EXPECT_EQ(both.channels.size(), 3u);
  EXPECT_EQ(both.channels.at("odis.albedo.R"), b.channels.at("albedo.R"));
  EXPECT_THROW(merge({{"", a}, {"", b}}), ImageError);

  const odis::test::TemporaryFolder folder;
  writeLayered(folder.path("both.exr"), both);
  EXPECT_EQ(readChannels(folder.path("both.exr")).channels, both.channels);
}

TEST(Difference, HasItsKinds) {
  const ColorImage a{2, 1, {Rgb(1, 2, 3), Rgb(0)}}, b{2, 1, {Rgb(2, 2, 1), Rgb(0)}};
  EXPECT_EQ(difference(a, b, DifferenceKind::signedColor).pixels[0], Rgb(-1, 0, 2));
  EXPECT_EQ(difference(a, b, DifferenceKind::absolute).pixels[0], Rgb(1, 0, 2));
  // Only the first pixel differs: twice the mean of all.
  const double relMse = odis::eval::compareImages(a, b).relMse;
  EXPECT_NEAR(difference(a, b, DifferenceKind::relative).pixels[0].x, 2 * relMse, 1e-5);
  const ColorImage flip = difference(a, b, DifferenceKind::flip);
  EXPECT_NEAR((flip.pixels[0].x + flip.pixels[1].x) / 2, compareImages(a, b).flip, 1e-6);
  EXPECT_THROW(difference(a, {1, 1, {Rgb(0)}}, DifferenceKind::absolute), std::invalid_argument);
}

TEST(Difference, BecomesColours) {
  const ColorImage d{4, 1, {Rgb(2), Rgb(-1), Rgb(0), Rgb(NAN)}};
  const ColorImage both = heatMap(d, true, 2);
  EXPECT_NEAR(both.pixels[0].x, 1, 1e-6);  // red above zero
  EXPECT_EQ(both.pixels[0].z, 0);
  EXPECT_GT(both.pixels[1].z, 0);  // blue below
  EXPECT_EQ(both.pixels[1].x, 0);
  EXPECT_EQ(both.pixels[2], Rgb(0));
  EXPECT_EQ(both.pixels[3], Rgb(0, 1, 0));
  const ColorImage one = heatMap(d, false, 2);
  EXPECT_GT(one.pixels[0].y, 0.9f);   // pale yellow
  EXPECT_LT(one.pixels[2].x, 0.01f);  // black
}

TEST(Difference, ColoursEndWhereMostPixelsDo) {
  ColorImage d{1000, 1, {}};
  for (int i = 0; i < 1000; ++i) d.pixels.emplace_back(i < 995 ? -0.5f : 1000.0f);
  EXPECT_NEAR(heatMapEnd(d), 0.5, 1e-6);
  EXPECT_EQ(heatMapEnd({1, 1, {Rgb(0)}}), 1);
}

}  // namespace
