// Textures from elements of a scene: parameters of Mitsuba 3 and 0.6, and errors.
#include <gtest/gtest.h>
#include <stb_image_write.h>

#include "render/scene/builder.h"
#include "support/temporary_folder.h"

namespace odis::render {
namespace {

class TextureFactories : public ::testing::Test {
 protected:
  // 4 x 3 pixels whose stored bytes are 0, 7, 14, ...
  TextureFactories() {
    std::vector<uint8_t> bytes(36);
    for (int i = 0; i < 36; ++i) bytes[i] = uint8_t(7 * i);
    stbi_write_png(m_folder.path("a.png").c_str(), 4, 3, 3, bytes.data(), 12);
  }

  std::shared_ptr<Properties> element(const std::string& type,
                                      const std::map<std::string, PropertyValue>& values) {
    auto node = std::make_shared<Properties>();
    node->tag = "texture";
    node->type = type;
    node->location = {m_folder.path("scene.xml"), 5, 1};
    for (const auto& [name, value] : values)
      node->parameters[name] = {value, {m_folder.path("scene.xml"), 6, 2}};
    return node;
  }
  TexturePtr make(const Properties& node) {
    const TextureFactory factory = findTextureFactory(node.type);
    if (!factory) throw std::runtime_error("no factory");
    return factory(node, m_builder);
  }
  TexturePtr bitmap(std::map<std::string, PropertyValue> values) {
    values["filename"] = std::string("a.png");
    const auto node = element("bitmap", values);
    const TexturePtr texture = make(*node);
    EXPECT_TRUE(node->unqueried().empty()) << node->unqueried().front().first;
    return texture;
  }
  std::string complaint(const Properties& node) {
    try {
      make(node);
    } catch (const SceneError& e) {
      return e.what();
    }
    return "";
  }

  test::TemporaryFolder m_folder;
  Warnings m_warnings;
  Builder m_builder{m_warnings};
};

void expectNear(const Rgb& found, const Rgb& expected, float tolerance = 1e-4f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << c;
}

// The expected numbers are those of Mitsuba 3.9 for the same image (it stores 16-bit floats).
TEST_F(TextureFactories, BitmapAgreesWithMitsuba) {
  const TexturePtr texture = bitmap({});
  expectNear(texture->rgb({0.3f, 0.4f}), {0.0894115f, 0.103994f, 0.119967f});
  EXPECT_NEAR(texture->scalar({0.3f, 0.4f}), 0.102045f, 1e-4f);
  EXPECT_NEAR(texture->gradient({0.3f, 0.4f}).x, 0.170021f, 5e-4f);
  EXPECT_NEAR(texture->gradient({0.3f, 0.4f}).y, 0.401638f, 5e-4f);
  EXPECT_NEAR(luminance(texture->mean()), 0.284846f, 1e-4f);
  expectNear(bitmap({{"raw", true}})->rgb({0.3f, 0.4f}), {0.288235f, 0.315686f, 0.343137f});
}

TEST_F(TextureFactories, BitmapOfMitsuba06) {
  expectNear(bitmap({{"gamma", 1.0}})->rgb({0.3f, 0.4f}), {0.288235f, 0.315686f, 0.343137f});
  expectNear(bitmap({{"gamma", -1.0}})->rgb({0.3f, 0.4f}), bitmap({})->rgb({0.3f, 0.4f}));
  // The centre of the first pixel of row 1: bytes 84, 91, 98.
  const Vec2 uv(0.125f, 0.5f);
  expectNear(bitmap({{"gamma", 2.0}})->rgb(uv), {sqr(84 / 255.0f), sqr(91 / 255.0f), sqr(98 / 255.0f)},
             1e-6f);
  EXPECT_NEAR(bitmap({{"raw", true}, {"channel", std::string("g")}})->scalar(uv), 91 / 255.0f, 1e-6f);
  EXPECT_NEAR(bitmap({{"channel", std::string("a")}})->scalar(uv), 1.0f, 1e-6f);
  const TexturePtr plain = bitmap({}), moved = bitmap({{"uscale", 2.0}, {"vscale", 3.0}, {"voffset", 0.2}});
  expectNear(moved->rgb({0.3f, 0.4f}), plain->rgb({0.6f, 1.4f}), 1e-6f);
  const std::string ewa = "ewa", clamp = "clamp", zero = "zero";
  EXPECT_EQ(
      bitmap({{"filter_type", ewa}, {"wrap_mode_u", clamp}, {"wrap_mode_v", zero}, {"max_anisotropy", 4.0}})
          ->rgb({0.5f, 9.0f}),
      Rgb(0.0f));
}

TEST_F(TextureFactories, BitmapTakesATransform) {
  Imath::M44d toUv;
  toUv.setScale(Imath::V3d(2, 3, 1));
  toUv[3][0] = 0.1;
  toUv[3][1] = 0.2;
  expectNear(bitmap({{"to_uv", toUv}})->rgb({0.3f, 0.4f}), bitmap({})->rgb({0.7f, 1.4f}), 1e-6f);
}

TEST_F(TextureFactories, ErrorsSayWhereAndWhat) {
  const std::pair<std::string, std::string> wrong[] = {
      {"filter_type", "sinc"}, {"wrap_mode", "fold"}, {"channel", "q"}};
  for (const auto& [name, value] : wrong) {
    const std::string text =
        complaint(*element("bitmap", {{"filename", std::string("a.png")}, {name, value}}));
    EXPECT_NE(text.find("scene.xml:6:2"), std::string::npos) << text;
    EXPECT_NE(text.find("found '" + value + "' for '" + name + "', expected one of"), std::string::npos)
        << text;
  }
  EXPECT_NE(complaint(*element("bitmap", {{"filename", std::string("a.png")}, {"gamma", -3.0}})), "");
  EXPECT_NE(complaint(*element("bitmap", {{"filename", std::string("b.png")}})).find("b.png"),
            std::string::npos);
  EXPECT_NE(complaint(*element("bitmap", {})), "");
  EXPECT_NE(complaint(*element("scale", {{"scale", 2.0}})).find("nested texture"), std::string::npos);
}

TEST_F(TextureFactories, CheckerboardAndScale) {
  const auto checkerboard = element("checkerboard", {{"color0", Rgb(1, 0, 0)}, {"uvscale", 0.5}});
  EXPECT_EQ(make(*checkerboard)->rgb({0.9f, 0.9f}), Rgb(1, 0, 0));
  EXPECT_EQ(make(*checkerboard)->rgb({1.1f, 0.9f}), Rgb(0.2f));
  const auto scale = element("scale", {{"scale", 3.0}});
  scale->children.push_back({"", checkerboard});
  EXPECT_EQ(make(*scale)->rgb({0.9f, 0.9f}), Rgb(3, 0, 0));
  EXPECT_TRUE(scale->unqueried().empty());
  EXPECT_EQ(findTextureFactory("no such texture"), nullptr);
}

}  // namespace
}  // namespace odis::render
