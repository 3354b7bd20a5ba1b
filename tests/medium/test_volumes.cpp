// Grids against Mitsuba 3.9.1 (scalar_rgb) and against their own bounds, files of all types, errors.
#include "medium/support.h"
#include "support/random.h"

namespace odis::test {
namespace {

using render::Matrix4;
using render::Rgb;
using render::Vec3;
using render::VolumePtr;

bool endsWithMessage(const std::string& text, const std::string& message) {
  return text.size() >= message.size() &&
         text.compare(text.size() - message.size(), message.size(), message) == 0;
}

// Inside, on the border between voxels, in the corners and beyond the cube.
const Vec3 kPlaces[] = {{0.1f, 0.2f, 0.3f},  {0.5f, 0.5f, 0.5f},   {0.97f, 0.99f, 0.02f},
                        {-0.4f, 1.7f, 0.5f}, {2.3f, -1.2f, -0.6f}, {0.9f, -0.05f, 3.1f}};

// mi.load_dict({'type': 'gridvolume', ...}).eval_1() of VolumeText's default at kPlaces.
struct GridLookUps {
  const char *wrap, *filter;
  float values[6];
};
const GridLookUps kMitsubaLookUps[] = {
    {"clamp", "trilinear", {0.2f, 0.8125f, 2.25f, 1.5f, 2.5f, 0.5f}},
    {"clamp", "nearest", {0, 0, 2.25f, 0.5f, 2.5f, 0.5f}},
    {"repeat", "trilinear", {0.39775f, 0.8125f, 1.277279f, 0.97f, 1.67725f, 1.695125f}},
    {"repeat", "nearest", {0, 0, 2.25f, 1.25f, 1.5f, 2.25f}},
    {"mirror", "trilinear", {0.2f, 0.8125f, 2.25f, 1.48f, 1.68025f, 0.5f}},
    {"mirror", "nearest", {0, 0, 2.25f, 2.5f, 2.25f, 0.5f}}};

TEST(Volumes, GridsAreLookedUpAsInMitsuba) {
  MediumParts parts;
  parts.write({});
  for (const GridLookUps& expected : kMitsubaLookUps) {
    const VolumePtr volume = parts.grid(std::string("<string name='wrap_mode' value='") + expected.wrap +
                                        "'/><string name='filter_type' value='" + expected.filter + "'/>");
    EXPECT_TRUE(volume->isGrey());
    for (int i = 0; i < 6; ++i) {
      const Vec3& p = kPlaces[i];
      EXPECT_NEAR(volume->scalar(p), expected.values[i], 2e-5f) << expected.wrap << expected.filter << i;
      EXPECT_EQ(volume->rgb(p), Rgb(volume->scalar(p)));
    }
  }
  EXPECT_TRUE(parts.isQuiet());
}

TEST(Volumes, ChannelsAreThoseOfMitsuba) {
  MediumParts parts;
  parts.write({.channels = 3});
  const Vec3 p(0.3f, 0.6f, 0.4f);
  const VolumePtr colour = parts.grid("<boolean name='raw' value='true'/>");
  EXPECT_EQ(colour->channels(), 3);
  const Rgb found = colour->rgb(kPlaces[0]), mitsuba(0.2f, 0.7f, 1.1725f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], mitsuba[c], 1e-6f);
  EXPECT_NEAR(colour->scalar(p), 1.220186f, 1e-5f);
  EXPECT_EQ(colour->greatest(), Rgb(2.5f));
  EXPECT_EQ(colour->least(), Rgb(0.0f));

  parts.write({.channels = 6});
  const VolumePtr volume = parts.grid();
  EXPECT_EQ(volume->channels(), 6);
  const std::array<float, 6> six = volume->six(p);
  const float expected[] = {1.07575f, 1.22925f, 1.556f, 1.2475f, 1.34325f, 0.82575f};
  for (size_t c = 0; c < 6; ++c) EXPECT_NEAR(six[c], expected[c], 1e-5f);
  EXPECT_NEAR(volume->scalar(p), 1.212917f, 1e-5f);
  EXPECT_TRUE(parts.isQuiet());
}

TEST(Volumes, TheBoxAndTheTransformAreThoseOfMitsuba) {
  MediumParts parts;
  parts.write({.box = {-1, 0, 2, 1, 0.5f, 5}});
  const std::string place =
      "<transform name='to_world'><matrix value='1.6212147 -0.15342544 0.29167622 1  0.45878735 2.8328888 "
      "-0.11798626 2  -1.077579 0.97529536 0.3885926 3  0 0 0 1'/></transform>";
  const Vec3 points[] = {{1.2f, 2.9f, 3.1f}, {2, 3, 3.5f}, {0.3f, 2.2f, 3.7f}};
  const float cube[] = {0.5592021f, 1.625231f, 0}, box[] = {1.433764f, 1.267272f, 0.8890476f};
  const VolumePtr inCube = parts.grid(place),
                  inBox = parts.grid("<boolean name='use_grid_bbox' value='true'/>" + place);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(inCube->scalar(points[i]), cube[i], 2e-5f);
    EXPECT_NEAR(inBox->scalar(points[i]), box[i], 2e-5f);
  }
  // A corner of the box, and one of the cube in the place of 0.6, which always takes the box.
  const VolumePtr unmoved = parts.grid("<boolean name='use_grid_bbox' value='true'/>"),
                  old = parts.grid("", "0.6.0");
  for (const VolumePtr& volume : {unmoved, old}) {
    ASSERT_TRUE(volume->toUnitCube());
    EXPECT_EQ(render::transformPoint(*volume->toUnitCube(), {1, 0.5f, 5}), Vec3(1));
    EXPECT_EQ(render::transformPoint(*volume->toUnitCube(), {-1, 0, 2}), Vec3(0));
  }
  EXPECT_TRUE(parts.isQuiet());
}

TEST(Volumes, OldGridsReachFromBorderToBorder) {
  MediumParts parts;
  parts.write({});
  const VolumePtr old = parts.grid("", "0.5.0");
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x)
        EXPECT_NEAR(old->scalar({float(x) / 3, float(y) / 2, float(z)}), patternAt(x, y, z, 0), 1e-5f);
  EXPECT_NEAR(old->scalar({0.5f, 0, 0}), (patternAt(1, 0, 0, 0) + patternAt(2, 0, 0, 0)) / 2, 1e-5f);
}

TEST(Volumes, AllTypesOfFilesHoldTheSame) {
  MediumParts parts;
  const auto shade = [](int x, int y, int z, int) { return float((x * 31 + y * 17 + z * 53) % 256) / 255; };
  Random random(3);
  for (const int32_t channels : {1, 3, 6}) {
    VolumeText text{.size = {5, 4, 3}, .channels = channels, .value = shade};
    parts.write(text);
    const VolumePtr full = parts.grid();
    for (const int32_t type : {2, 3}) {
      text.type = type;
      parts.write(text);
      const VolumePtr volume = parts.grid();
      EXPECT_EQ(volume->channels(), channels);
      EXPECT_EQ(volume->bytes(), full->bytes() / (type == 2 ? 2 : 4));
      for (int i = 0; i < 100; ++i) {
        const Vec3 p = random.inCube(1);
        const float tolerance = type == 2 ? 3e-4f : 1e-6f;
        EXPECT_NEAR(volume->scalar(p), full->scalar(p), tolerance);
        EXPECT_NEAR(volume->rgb(p).z, full->rgb(p).z, tolerance);
        EXPECT_NEAR(volume->six(p)[5], full->six(p)[5], tolerance);
      }
    }
  }
}

// The bound of the box that a point of the unit cube lies in.
float boundAt(const render::VolumeMaxima& maxima, const Vec3& p) {
  size_t index = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const uint32_t n = maxima.size[size_t(axis)];
    index = index * n + std::min(uint32_t(p[axis] * float(n)), n - 1);
  }
  return maxima.values[index];
}

TEST(Volumes, MaximaBound) {
  MediumParts parts;
  Random random(7);
  const std::array<int32_t, 3> sizes[] = {{1, 1, 1}, {7, 9, 8}, {33, 2, 17}, {600, 3, 1}};
  for (const auto& size : sizes)
    for (const char* wrap : {"clamp", "repeat", "mirror"})
      for (const char* filter : {"trilinear", "nearest"})
        for (const char* version : {"3.0.0", "0.6.0"}) {
          // Mostly empty, so that boxes differ, with a few great values and negative ones.
          parts.write({.size = size, .channels = 3, .value = [&](int, int, int, int) {
                         const float u = random();
                         return u < 0.9f ? 0 : u < 0.95f ? 100 * random() : random() - 3;
                       }});
          const VolumePtr volume = parts.grid(std::string("<string name='wrap_mode' value='") + wrap +
                                                  "'/><string name='filter_type' value='" + filter + "'/>",
                                              version);
          const render::VolumeMaxima maxima = volume->maxima();
          ASSERT_EQ(maxima.values.size(), size_t(maxima.size[0]) * maxima.size[1] * maxima.size[2]);
          for (size_t axis = 0; axis < 3; ++axis)
            EXPECT_EQ(maxima.size[axis], std::min(uint32_t(size[axis] + 7) / 8, 64u));
          int above = 0, tight = 0;
          for (int i = 0; i < 4000; ++i) {
            Vec3 p(random(), random(), random());
            // On the borders of boxes as well.
            if (i % 4 == 0)
              for (int axis = 0; axis < 3; ++axis)
                p[axis] =
                    std::round(p[axis] * float(maxima.size[size_t(axis)])) / float(maxima.size[size_t(axis)]);
            const float bound = boundAt(maxima, p);
            const Rgb value = volume->rgb(p);
            above += render::maxComponent(value) > bound;
            tight += bound < render::maxComponent(volume->greatest());
            for (int c = 0; c < 3; ++c) {
              EXPECT_LE(value[c], volume->greatest()[c] * 1.000001f);
              EXPECT_GE(value[c], volume->least()[c] * (volume->least()[c] < 0 ? 1.000001f : 1));
            }
          }
          EXPECT_EQ(above, 0) << size[0] << wrap << filter << version;
          if (maxima.values.size() > 4) EXPECT_GT(tight, 1000);
        }
}

TEST(Volumes, WhereMaximaMatterMostTheyAreExact) {
  // A wall of 1 at the end: no box but the last, and the one that touches it by repetition, holds any.
  MediumParts parts;
  parts.write({.size = {64, 8, 8}, .value = [](int x, int, int, int) { return x == 63 ? 1.0f : 0.0f; }});
  const std::vector<float> clamped = parts.grid()->maxima().values;
  const std::vector<float> repeated =
      parts.grid("<string name='wrap_mode' value='repeat'/>")->maxima().values;
  ASSERT_EQ(clamped.size(), 8u);
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(clamped[i], i == 7 ? 1 : 0, 1e-5);
    EXPECT_NEAR(repeated[i], i == 7 || i == 0 ? 1 : 0, 1e-5);
  }
}

TEST(Volumes, ParametersAreVolumesColoursOrNumbers) {
  MediumParts parts;
  parts.write({});
  const auto made = [&](const std::string& inside, const render::NumberRange& range = render::kAnyNumber,
                        bool clamped = false) {
    return parts.builder().volume(parts.parsed("<medium type='m'>" + inside + "</medium>"), "albedo",
                                  {.type = "volume", .range = range, .clamped = clamped}, Rgb(0.75f));
  };
  const VolumePtr absent = made(""), colour = made("<rgb name='albedo' value='0.2, 0.5, 0.9'/>"),
                  number = made("<float name='albedo' value='0.25'/>"),
                  constant = made(
                      "<volume type='constvolume' name='albedo'><rgb name='value' "
                      "value='0.2, 0.5, 0.9'/></volume>");
  EXPECT_EQ(absent->rgb({}), Rgb(0.75f));
  EXPECT_EQ(number->scalar({}), 0.25f);
  EXPECT_TRUE(number->isGrey());
  for (const VolumePtr& volume : {colour, constant}) {
    EXPECT_TRUE(volume->isConstant());
    EXPECT_EQ(volume->channels(), 3);
    EXPECT_EQ(volume->rgb({1, 2, 3}), Rgb(0.2f, 0.5f, 0.9f));
    EXPECT_NEAR(volume->scalar({}), 0.533333f, 1e-6f);  // as in Mitsuba
    EXPECT_EQ(volume->maxima().values, std::vector<float>{0.9f});
    EXPECT_FALSE(volume->toUnitCube());
  }
  EXPECT_TRUE(parts.isQuiet());

  const std::string grid =
      "<volume type='gridvolume' name='albedo'><string name='filename' value='grid.vol'/></volume>";
  EXPECT_TRUE(made(grid)->isGrey());
  EXPECT_TRUE(endsWithMessage(complaintOf([&] { made(grid, render::between(0, 1)); }),
                              "found values from 0 to 2.5 in the volume for 'albedo', expected 0 to 1"));
  EXPECT_TRUE(made(grid, render::between(0, 1), true));
  EXPECT_TRUE(
      parts.warnsOf("found values from 0 to 2.5 in the volume for 'albedo', which are clamped to 0 to 1"));
  parts.write({.channels = 6});
  EXPECT_TRUE(endsWithMessage(complaintOf([&] { made(grid); }),
                              "found a volume of 6 channels for 'albedo', expected 1 or 3"));
  EXPECT_EQ(made("<volume type='gridvolum' name='albedo'/>")->rgb({}), Rgb(1.0f));
  EXPECT_TRUE(parts.warnsOf("the volume 'gridvolum' is unknown (did you mean 'gridvolume'?)"));
}

TEST(Volumes, ElementsAreMadeOnce) {
  MediumParts parts;
  const Properties& node = parts.parsed("<volume type='constvolume'/>");
  EXPECT_EQ(parts.builder().volume(node), parts.builder().volume(node));
  const Properties& phase = parts.parsed("<phase type='hg'/>");
  EXPECT_EQ(parts.builder().phaseFunction(phase), parts.builder().phaseFunction(phase));
}

TEST(Volumes, SaysWhatIsWrongWithAFile) {
  MediumParts parts;
  const auto complaint = [&](const VolumeText& text, const std::string& parameters = "") {
    parts.write(text);
    return complaintOf([&] { parts.grid(parameters); });
  };
  EXPECT_TRUE(endsWithMessage(complaint({.channels = 2}), "grid.vol: found 2 channels, expected 1, 3 or 6"));
  EXPECT_TRUE(endsWithMessage(complaint({.type = 4}),
                              "grid.vol: found values of type 4, expected 1 (float32), 2 (float16) or 3 "
                              "(uint8)"));
  const auto infinite = [](int, int, int, int) { return INFINITY; };
  for (const int32_t type : {1, 2})
    EXPECT_TRUE(endsWithMessage(complaint({.type = type, .value = infinite}),
                                "grid.vol: the volume holds values that aren't finite"));
  EXPECT_TRUE(endsWithMessage(complaint({.size = {0, 3, 2}}),
                              "grid.vol: found a grid of 0 x 3 x 2 values of 1 channels, expected at least 1 "
                              "along each axis and no more than the 0 numbers in the file"));
  const std::string bytes = VolumeText{.channels = 3}.text();
  parts.write("grid.vol", bytes.substr(0, bytes.size() - 1));
  EXPECT_TRUE(endsWithMessage(complaintOf([&] { parts.grid(); }),
                              "grid.vol: found a grid of 4 x 3 x 2 values of 3 channels, expected at least 1 "
                              "along each axis and no more than the 71 numbers in the file"));
  EXPECT_TRUE(
      endsWithMessage(complaint({.box = {0, 0, 0, 1, 0, 1}}, "<boolean name='use_grid_bbox' value='true'/>"),
                      "grid.vol: found a box from 0, 0, 0 to 1, 0, 1, expected one that has a volume"));
  EXPECT_EQ(complaint({.box = {0, 0, 0, 1, 0, 1}}), "");
  EXPECT_TRUE(parts.isQuiet());
  complaint({}, "<float name='max_value' value='2'/><string name='filtre_type' value='nearest'/>");
  EXPECT_TRUE(parts.warnsOf("'max_value' is 2, but the grid holds 2.5, which is drawn"));
  EXPECT_TRUE(
      parts.warnsOf("unknown parameter 'filtre_type' of the volume 'gridvolume' is ignored (did you "
                    "mean 'filter_type'?)"));
}

TEST(Volumes, ATextureShowsThemOnSurfaces) {
  MediumParts parts;
  parts.write({.channels = 3});
  const render::TexturePtr texture = parts.texture(
      "<texture type='volume'><volume type='gridvolume' name='volume'><string name='filename' "
      "value='grid.vol'/></volume></texture>");
  render::SurfacePoint at;
  at.p = kPlaces[0];
  EXPECT_NEAR(texture->rgbAt(at).y, 0.7f, 1e-6f);
  EXPECT_NEAR(texture->scalarAt(at), render::luminance(texture->rgbAt(at)), 1e-6f);
  EXPECT_FALSE(texture->isConstant());
  EXPECT_EQ(texture->mean(), Rgb(1.25f));
  EXPECT_EQ(parts.texture("<texture type='volume'/>")->mean(), Rgb(0.75f));
  EXPECT_TRUE(parts.texture("<texture type='volume'/>")->isConstant());
  EXPECT_TRUE(parts.isQuiet());
}

}  // namespace
}  // namespace odis::test
