// The page of a comparison: one well-formed file that holds all its pictures and asks for nothing else.
#include "eval/report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "eval/comparison_json.h"
#include "eval/exposure.h"
#include "eval/report_pictures.h"
#include "render/image/image.h"
#include "support/temporary_folder.h"

using namespace odis::eval;
using odis::render::Rgb;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kWidth = 12, kHeight = 8;

// Two scenes, two methods, two numbers of samples and one rendering at equal time, with names and a command
// that try to break out of the page.
class Report : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(m_folder.path("images"));
    int number = 0;
    for (const char* scene : {"room", "a</script><b>"}) {
      SceneRecord& record = m_comparison.scenes.emplace_back();
      record.name = scene;
      record.width = kWidth;
      record.height = kHeight;
      record.reference = m_folder.path(fmt::format("reference-{}.exr", number));
      record.referenceError = ReferenceError{0.01, 0.02};
      writeColor(record.reference, frameOf(1), kWidth, kHeight, {});
      for (const int spp : {4, 16})
        for (const char* method : {"path", "odis"}) addRun(scene, method, spp, false, number++);
      addRun(scene, "odis", 16, true, number++);
    }
  }
  void addRun(const char* scene, const char* method, int spp, bool equalTime, int number) {
    Measurement& m = m_comparison.measurements.emplace_back();
    m.scene = scene;
    m.method = method;
    m.spp = spp;
    m.samples = spp;
    m.equalTime = equalTime;
    m.error.trimmedRelMse = 1.0 / spp;
    m.seconds = 1;
    m.rays = 100;
    m.image = fmt::format("images/{}.exr", number);
    writeColor(m_folder.path(m.image), frameOf(1 + 0.1f * float(number)), kWidth, kHeight, {});
  }
  // A ramp from black far into what no screen can show.
  static odis::render::RenderedImage frameOf(float brightness) {
    odis::render::RenderedImage frame;
    frame.width = kWidth;
    frame.height = kHeight;
    for (int i = 0; i < kWidth * kHeight; ++i)
      frame.color.emplace_back(brightness * 0.01f * float(i), brightness * 0.1f, brightness * float(i % 5));
    return frame;
  }
  std::string page(size_t pictureBytes = kReportBytes) const {
    const auto rows = summarize(m_comparison.measurements);
    const std::vector<Method> methods{{"path", "--integrator path", {}},
                                      {"odis", "--set bsdf-fraction=0.5", {}}};
    const Json json = comparisonJson(m_comparison, rows, methods, {"odis compare {{style}} \xff", "machine"});
    return reportPage(m_comparison, rows, json, m_folder.path(""), pictureBytes);
  }
  static std::string textBetween(const std::string& page, const std::string& begin, const std::string& end) {
    const size_t from = page.find(begin);
    if (from == std::string::npos) return "";
    return page.substr(from + begin.size(), page.find(end, from + begin.size()) - from - begin.size());
  }
  static Json dataOf(const std::string& page) {
    return Json::parse(textBetween(page, "<script type=\"application/json\" id=\"data\">", "</script>"));
  }
  static std::string pictureOf(const std::string& page, const std::string& id) {
    return textBetween(page, fmt::format("class=\"picture\" id=\"{}\">", id), "<");
  }
  // The first element that is not closed, or is closed without being open; "" if all is well.
  static std::string badNesting(const std::string& page) {
    std::vector<std::string> open;
    const std::regex tag(R"(<(/?)([a-zA-Z][a-zA-Z0-9]*)([^<>]*?)(/?)>)");
    for (size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at)) {
      if (page.compare(at, 2, "<!") == 0) {  // the document's type and comments
        at = page.compare(at, 4, "<!--") == 0 ? page.find("-->", at) : page.find('>', at);
        continue;
      }
      std::smatch match;
      const std::string here = page.substr(at, 600);
      if (!std::regex_search(here, match, tag, std::regex_constants::match_continuous)) return here;
      at += size_t(match.length());
      const std::string name = match[2];
      if (match[1] == "/") {
        if (open.empty() || open.back() != name) return "</" + name + ">";
        open.pop_back();
      } else if (match[4] != "/") {
        open.push_back(name);
        // What these hold is text up to their end.
        if (name == "script" || name == "style") at = page.find("</" + name, at);
      }
    }
    return open.empty() ? "" : "<" + open.back() + ">";
  }

  const odis::test::TemporaryFolder m_folder;
  Comparison m_comparison;
};

TEST_F(Report, IsWellFormed) {
  const std::string text = page();
  EXPECT_EQ(text.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_EQ(badNesting(text), "");
  EXPECT_NE(badNesting("<p><b></p>"), "");  // the check itself works
  for (const char* mark : {"{{data}}", "{{script}}", "{{pictures}}"})
    EXPECT_EQ(text.find(mark), std::string::npos) << mark;
  EXPECT_NE(text.find("function drawForest"), std::string::npos);
  EXPECT_NE(text.find("border-collapse"), std::string::npos);
}

TEST_F(Report, AsksForNothingElse) {
  const std::string text = page();
  for (const char* outside : {"http://", "https://", "file://", "src=", "<link", "<iframe", "@import", "url(",
                              "fetch(", "XMLHttpRequest", "import("})
    EXPECT_EQ(text.find(outside), std::string::npos) << outside;
  EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
}

TEST_F(Report, HoldsAllPictures) {
  const std::string text = page();
  const Json data = dataOf(text);
  std::set<std::string> ids;
  for (const Json& scene : data.at("scenes")) {
    ids.insert(scene.at("referencePicture"));
    ASSERT_EQ(scene.at("pictures").size(), 5u);
    for (const Json& picture : scene.at("pictures")) {
      ids.insert(picture.at("id"));
      ids.insert(picture.at("flip"));
    }
  }
  EXPECT_EQ(ids.size(), 2u * (1 + 5 * 2));
  for (const std::string& id : ids)
    EXPECT_EQ(pictureOf(text, id).rfind("iVBORw0KGgo", 0), 0u) << id;  // how a PNG begins
  EXPECT_TRUE(data.at("leftOut").empty());
}

TEST_F(Report, CarriesTheFigures) {
  const Json data = dataOf(page());
  EXPECT_EQ(data.at("rows").size(), 2u * 5 + 5);  // and means
  EXPECT_EQ(data.at("runs").size(), 10u);
  EXPECT_EQ(data.at("scenes").at(1).at("name"), "a</script><b>");
  EXPECT_EQ(data.at("command").get<std::string>().rfind("odis compare {{style}}", 0), 0u);
  EXPECT_EQ(data.at("methods").at(1).at("options"), "--set bsdf-fraction=0.5");
  EXPECT_GT(data.at("scenes").at(0).at("mean"), 0);
}

// What does not fit is left out from the most samples on, and named; the fewest samples stay.
TEST_F(Report, KeepsToItsSize) {
  const std::string text = page(1);
  const Json data = dataOf(text);
  EXPECT_EQ(data.at("leftOut"), Json::array({16}));
  for (const Json& scene : data.at("scenes")) {
    EXPECT_EQ(scene.at("pictures").size(), 2u);
    for (const Json& picture : scene.at("pictures")) EXPECT_EQ(picture.at("spp"), 4);
  }
  EXPECT_LT(text.size(), page().size());
}

// From RFC 4648.
TEST(Base64, IsThatOfTheStandard) {
  const std::map<std::string, std::string> known{
      {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : known) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

// Decoded as the page does it, light comes back to within half a step of 256 over 14 stops.
TEST(ReportPicture, KeepsTheLight) {
  ColorImage image{64, 1, {}};
  for (int i = 0; i < 64; ++i)
    image.pixels.emplace_back(std::exp2(float(i) * 0.25f - 9), 0.18f, i == 5 ? -1 : 1e9f);
  const odis::test::TemporaryFolder folder;
  std::string bytes;  // base64 back to bytes
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  uint32_t bits = 0;
  int count = 0;
  for (const char c : encodePicture(image, 2)) {
    if (c == '=') break;
    bits = bits << 6 | uint32_t(kDigits.find(c));
    if ((count += 6) >= 8) bytes += char(bits >> (count -= 8));
  }
  std::ofstream(folder.path("a.png"), std::ios::binary) << bytes;
  const auto read = odis::render::Image::read(folder.path("a.png"), false, {});
  ASSERT_EQ(read->width(), 64);
  const auto decoded = [&](float stored) {
    return (std::pow(1 + kPictureScale * kPictureMost, double(stored)) - 1) / kPictureScale;
  };
  const double step = std::log(1 + kPictureScale * kPictureMost) / 255;
  for (int x = 0; x < 64; ++x) {
    const double truth = 2 * double(image.pixels[size_t(x)].x);
    EXPECT_NEAR(decoded(read->rgb(x, 0).x), truth, 0.55 * step * (truth + 1 / kPictureScale)) << x;
    EXPECT_NEAR(decoded(read->rgb(x, 0).z), x == 5 ? 0 : kPictureMost, 1e-3);
  }
}

}  // namespace
