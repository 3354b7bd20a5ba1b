// Motion while the shutter is open, against the mean of many pictures of scenes that stand still: each of
// them is written with the transforms of its moment, so nothing that moves is in them.
#include <fmt/format.h>

#include "integrator/same_expectation.h"

namespace odis::test {
namespace {

using namespace render;

constexpr int kMoments = 96;

// The same place twice: as an animation, and at a moment. Times go from 0 to 1.
struct Place {
  std::string animation;
  std::function<std::string(double time)> at;
};

std::string transform(const std::string& steps) {
  return "<transform name='to_world'>" + steps + "</transform>";
}

std::string keyFrame(double time, const std::string& steps) {
  return fmt::format("<transform time='{}'>{}</transform>", time, steps);
}

// Scaled, turned about an axis, then moved; all three change.
Place tumbling(const std::string& axis, const Vec3& from, const Vec3& to, double scale = 0.3,
               double grow = 1) {
  const auto steps = [=](double t) {
    const double size = scale * (1 + (grow - 1) * t);
    return fmt::format(
        "<scale x='{}' y='{}' z='{}'/><rotate {} angle='{}'/><translate x='{}' y='{}' z='{}'/>", size, size,
        scale, axis, 20 + 100 * t, from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t,
        from.z + (to.z - from.z) * t);
  };
  return {"<animation name='to_world'>" + keyFrame(0, steps(0)) + keyFrame(1, steps(1)) + "</animation>",
          [=](double t) { return transform(steps(t)); }};
}

std::string wall(const std::string& steps, const std::string& color) {
  return "<shape type='rectangle'>" + transform(steps) +
         "<bsdf type='twosided'><bsdf type='diffuse'><rgb name='reflectance' value='" + color +
         "'/></bsdf></bsdf></shape>";
}

// A box that is open towards the camera, with a lamp at its ceiling unless others light it.
std::string room(bool lamp) {
  std::string result = wall("<rotate x='1' angle='-90'/><translate y='-1'/>", "0.7 0.7 0.7") +
                       wall("<rotate x='1' angle='90'/><translate y='1'/>", "0.7 0.7 0.7") +
                       wall("<translate z='-1'/>", "0.6 0.6 0.7") +
                       wall("<rotate y='1' angle='90'/><translate x='-1'/>", "0.7 0.2 0.2") +
                       wall("<rotate y='1' angle='-90'/><translate x='1'/>", "0.2 0.7 0.2");
  if (lamp)
    result += "<shape type='rectangle'>" +
              transform("<scale value='0.3'/><rotate x='1' angle='90'/><translate y='0.98'/>") +
              "<emitter type='area'><rgb name='radiance' value='6'/></emitter></shape>";
  return result;
}

std::string camera(const std::string& place, double open = 0, double close = 1) {
  return fmt::format(
             "<sensor type='perspective'><float name='fov' value='38'/>"
             "<float name='shutter_open' value='{}'/><float name='shutter_close' value='{}'/>",
             open, close) +
         place +
         "<film type='hdrfilm'><integer name='width' value='12'/><integer name='height' value='12'/>"
         "<rfilter type='box'/></film></sensor>";
}
const std::string kStill = camera(transform("<lookat origin='0,0,3.4' target='0,0,0' up='0,1,0'/>"));

const std::string kEmission = "<emitter type='area'><rgb name='radiance' value='9, 8, 7'/></emitter>";

struct MovingScene {
  const char* name;
  std::string moving;
  std::function<std::string(double time)> at;
};

MovingScene withPlace(const char* name, const Place& place, const std::string& before,
                      const std::string& after) {
  return {name, before + place.animation + after, [=](double t) { return before + place.at(t) + after; }};
}

std::vector<MovingScene> movingScenes() {
  const Vec3 left(-0.5f, -0.3f, 0), right(0.5f, 0.2f, 0.3f), high(0.4f, 0.5f, -0.2f);
  const std::string lit = kStill + room(true), dark = kStill + room(false);
  const std::string group =
      "<shape type='shapegroup' id='g'><shape type='cube'/><shape type='sphere'><point name='center' x='0' "
      "y='1.5' z='0'/><float name='radius' value='0.5'/><bsdf type='roughconductor'/></shape></shape>";
  std::vector<MovingScene> scenes;
  scenes.push_back(withPlace("a sphere of glass", tumbling("y='1'", left, right, 0.4),
                             lit + "<shape type='sphere'>", "<bsdf type='dielectric'/></shape>"));
  scenes.push_back(
      withPlace("a mesh", tumbling("x='0.6' y='0.8'", left, right), lit + "<shape type='cube'>", "</shape>"));
  scenes.push_back(withPlace("an instance", tumbling("z='1'", left, right, 0.25),
                             lit + group + "<shape type='instance'><ref id='g'/>", "</shape>"));
  scenes.push_back(withPlace("a mesh that shines", tumbling("x='1'", left, high, 0.2, 1.5),
                             dark + "<shape type='cube'>", kEmission + "</shape>"));
  scenes.push_back(withPlace("a sphere that shines", tumbling("x='1'", left, high, 0.2),
                             dark + "<shape type='sphere'>", kEmission + "</shape>"));
  scenes.push_back(withPlace("a disk that shines and is stretched", tumbling("x='1'", left, high, 0.2, 3),
                             dark + "<shape type='disk'>", kEmission + "</shape>"));
  const std::string spot =
      "<rgb name='intensity' value='3'/><float name='cutoff_angle' value='50'/></emitter>";
  scenes.push_back(withPlace("a spot light", tumbling("y='1'", {0, 0, 0.5f}, {-0.5f, 0.3f, 0.5f}, 1),
                             dark + "<emitter type='spot'>", spot));
  return scenes;
}

RenderOptions pathOptions() {
  RenderOptions options;
  options.integrator = IntegratorKind::path;
  options.maxDepth = 4;
  options.sampler = SamplerKind::independent;
  return options;
}

// The mean over moments, one in each of as many parts of the shutter time: an image of `add` each.
PixelStatistics meanOfMoments(const std::function<std::string(double time)>& sceneAt, double open = 0,
                              double close = 1) {
  // Each round visits all parts once, so that rounds are alike and their spread is that of their mean.
  constexpr int kRounds = 24;
  PixelStatistics result;
  std::vector<std::unique_ptr<Scene>> moments;
  std::vector<double> parts;
  for (int i = 0; i < kMoments; ++i)
    moments.push_back(loadScene(sceneAt(open + (i + 0.5) / kMoments * (close - open))));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Rgb> mean;
    for (int i = 0; i < kMoments; ++i) {
      RenderOptions options = pathOptions();
      options.spp = 1;
      options.seed = uint64_t(1 + round * kMoments + i);
      const std::vector<Rgb> image = renderScene(*moments[size_t(i)], options).image.color;
      mean.resize(image.size(), Rgb(0, 0, 0));
      for (size_t p = 0; p < image.size(); ++p) mean[p] += image[p] / float(kMoments);
    }
    result.add(mean);
  }
  return result;
}

class MotionBlur : public testing::TestWithParam<int> {};

TEST_P(MotionBlur, IsTheMeanOfMoments) {
  const MovingScene moving = movingScenes()[size_t(GetParam())];
  SCOPED_TRACE(moving.name);
  const auto scene = loadScene(moving.moving);
  ASSERT_TRUE(scene->moves());
  const PixelStatistics expected = meanOfMoments(moving.at);
  RenderOptions options = pathOptions();
  options.spp = 64;
  expectSameExpectation(renderSeeds(*scene, options, 32, 90000), expected, 4 * int(movingScenes().size()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, MotionBlur, testing::Range(0, int(movingScenes().size())));

TEST(MotionBlur, OfTheCamera) {
  const auto place = [](double t) {
    return fmt::format("<lookat origin='{},0.1,3.4' target='0,0,0' up='0,1,0'/>", t);
  };
  // Translated alone, so that its moments can be written down.
  const auto moved = [&](double t) { return place(0) + fmt::format("<translate x='{}' y='0.2'/>", t); };
  const std::string inside = room(true) + "<shape type='sphere'><float name='radius' value='0.4'/></shape>";
  const auto scene = loadScene(
      camera("<animation name='to_world'>" + keyFrame(0, moved(0)) + keyFrame(1, moved(1)) + "</animation>") +
      inside);
  ASSERT_TRUE(scene->moves());
  RenderOptions options = pathOptions();
  options.spp = 64;
  expectSameExpectation(renderSeeds(*scene, options, 32, 90000),
                        meanOfMoments([&](double t) { return camera(transform(moved(t))) + inside; }), 4);
}

// Three key frames that are not evenly spread, and a shutter that opens before the first and closes between
// the last two.
TEST(MotionBlur, FollowsTheShutterAndAllKeyFrames) {
  const auto at = [](double t) {
    const double x = t < 2 ? -0.5 : t < 3 ? -0.5 + (t - 2) : 0.5, y = t < 3 ? 0 : (t - 3) / 4;
    return fmt::format("<scale value='0.3'/><translate x='{}' y='{}'/>", x, y);
  };
  const double open = 1.5, close = 5;
  const auto view = [&] {
    return camera(transform("<lookat origin='0,0,3.4' target='0,0,0' up='0,1,0'/>"), open, close) +
           room(true);
  }();
  const auto scene = loadScene(view + "<shape type='cube'><animation name='to_world'>" + keyFrame(2, at(2)) +
                               keyFrame(3, at(3)) + keyFrame(7, at(7)) + "</animation></shape>");
  RenderOptions options = pathOptions();
  options.spp = 64;
  expectSameExpectation(
      renderSeeds(*scene, options, 32, 90000),
      meanOfMoments([&](double t) { return view + "<shape type='cube'>" + transform(at(t)) + "</shape>"; },
                    open, close),
      4);
}

// Guides know the mean over the shutter time alone, which must not matter.
TEST(MotionBlur, IsTheSameWithGuides) {
  for (const int index : {2, 3}) {
    const MovingScene moving = movingScenes()[size_t(index)];
    SCOPED_TRACE(moving.name);
    const auto scene = loadScene(moving.moving);
    RenderOptions options = pathOptions();
    options.spp = 32;
    const PixelStatistics path = renderSeeds(*scene, options, 48, 500);
    for (const IntegratorKind kind : {IntegratorKind::odis, IntegratorKind::ppg}) {
      SCOPED_TRACE(int(kind));
      options.integrator = kind;
      expectSameExpectation(renderSeeds(*scene, options, 48, 9000), path, 4 * 4);
    }
  }
}

// Resampling shares samples among pixels, which see a moment together: only means over the image of different
// seeds are independent.
TEST(MotionBlur, IsTheSameWithResampling) {
  const auto scene = loadScene(movingScenes()[3].moving);
  const auto means = [&](IntegratorKind kind, uint64_t firstSeed) {
    RenderOptions options = pathOptions();
    options.integrator = kind;
    options.spp = 16;
    PixelStatistics result;
    for (uint64_t seed = firstSeed; seed < firstSeed + 200; ++seed) {
      options.seed = seed;
      const std::vector<Rgb> image = renderScene(*scene, options).image.color;
      Rgb sum(0, 0, 0);
      for (const Rgb& pixel : image) sum += pixel;
      result.add({sum / float(image.size())});
    }
    return result;
  };
  expectSameExpectation(means(IntegratorKind::restir, 9000), means(IntegratorKind::path, 500), 4);
}

TEST(MotionBlur, IsLeftOutWhereTheShutterIsClosed) {
  const Place place = tumbling("y='1'", {-0.5f, 0, 0}, {0.5f, 0, 0});
  const std::string look = transform("<lookat origin='0,0,3.4' target='0,0,0' up='0,1,0'/>");
  const std::string rest = room(true) + "<shape type='cube'>";
  const auto moving = loadScene(camera(look, 0.25, 0.25) + rest + place.animation + "</shape>");
  EXPECT_FALSE(moving->moves());
  EXPECT_TRUE(moving->instances().empty());
  RenderOptions options = pathOptions();
  options.spp = 4;
  const auto found = renderScene(*moving, options).image.color;
  const auto expected =
      renderScene(*loadScene(camera(look) + rest + place.at(0.25) + "</shape>"), options).image.color;
  // Rounding moves few paths to another side of an edge.
  int same = 0;
  for (size_t i = 0; i < found.size(); ++i)
    same += std::abs(found[i].y - expected[i].y) < 1e-3f * expected[i].y;
  EXPECT_GT(same, int(found.size() * 9 / 10));
}

}  // namespace
}  // namespace odis::test
