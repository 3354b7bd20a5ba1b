// Every format that scenes use, from files that the test writes, whole and broken.
#include <gtest/gtest.h>
#include <stb_image_write.h>
#include <zlib.h>

#include <cstdio>  // for jpeglib.h
#include <random>

#include <jpeglib.h>

#include "image/files.h"
#include "render/image/srgb.h"
#include "render/image/write.h"
#include "support/temporary_folder.h"

namespace odis::render {
namespace {

const SourceLocation kAt{"scene.xml", 12, 3};

// A greyscale PNG of 16 bits, which stb can not write.
std::string png16(int width, int height, const std::vector<uint16_t>& values) {
  const auto big = [](uint32_t v) {
    return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
  };
  const auto chunk = [&](const std::string& name, const std::string& data) {
    const std::string body = name + data;
    const uLong crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
    return big(uint32_t(data.size())) + body + big(uint32_t(crc));
  };
  std::string rows;
  for (int y = 0; y < height; ++y) {
    rows += '\0';  // no row filter
    for (int x = 0; x < width; ++x) {
      const uint16_t v = values[y * width + x];
      rows += char(v >> 8);
      rows += char(v & 255);
    }
  }
  uLongf size = compressBound(uLong(rows.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
           uLong(rows.size()));
  packed.resize(size);
  const std::string header = big(uint32_t(width)) + big(uint32_t(height)) + std::string{16, 0, 0, 0, 0};
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", packed) + chunk("IEND", "");
}

// 3 x 2 pixels, row 0 first.
const std::vector<uint8_t> kRgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30, 128, 128, 128, 250, 240, 230};

TEST(ReadImage, LosslessEightBit) {
  const test::TemporaryFolder folder;
  stbi_write_png(folder.path("a.png").c_str(), 3, 2, 3, kRgb.data(), 9);
  stbi_write_tga(folder.path("a.tga").c_str(), 3, 2, 3, kRgb.data());
  stbi_write_bmp(folder.path("a.bmp").c_str(), 3, 2, 3, kRgb.data());
  for (const char* name : {"a.png", "a.tga", "a.bmp"})
    for (bool srgb : {false, true}) {
      const auto image = Image::read(folder.path(name), srgb, kAt);
      ASSERT_EQ(image->width(), 3) << name;
      ASSERT_EQ(image->height(), 2);
      ASSERT_EQ(image->channels(), 3);
      EXPECT_FALSE(image->hasAlpha());
      EXPECT_EQ(image->alpha(2, 1), 1.0f);
      EXPECT_LT(image->bytes(), 2000u);
      Rgb sum(0.0f);
      for (int i = 0; i < 6; ++i) {
        const Rgb read = image->rgb(i % 3, i / 3);
        for (int c = 0; c < 3; ++c) {
          const float stored = float(kRgb[3 * i + c]) / 255.0f;
          EXPECT_FLOAT_EQ(read[c], srgb ? srgbDecode(stored) : stored) << name << " " << i << " " << c;
        }
        EXPECT_FLOAT_EQ(image->scalar(i % 3, i / 3), luminance(read));
        sum += read;
      }
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(image->mean()[c], sum[c] / 6, 1e-6f);
    }
}

TEST(ReadImage, JpegIsCloseToTheOriginal) {
  const test::TemporaryFolder folder;
  std::vector<uint8_t> pixels(32 * 16 * 3);
  for (int i = 0; i < 32 * 16; ++i)
    for (int c = 0; c < 3; ++c) pixels[3 * i + c] = uint8_t(50 + (i % 32) * 4 + c * 20);
  stbi_write_jpg(folder.path("a.jpg").c_str(), 32, 16, 3, pixels.data(), 100);
  const auto image = Image::read(folder.path("a.jpg"), false, kAt);
  ASSERT_EQ(image->width(), 32);
  ASSERT_EQ(image->height(), 16);
  for (int i = 0; i < 32 * 16; ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image->rgb(i % 32, i / 32)[c], float(pixels[3 * i + c]) / 255.0f, 4.0f / 255.0f);
}

// Files as cameras and printers make them: of one channel, and of the inks that are left out.
TEST(ReadImage, JpegOfGreyAndOfInks) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("a.jpg");
  for (const int channels : {1, 4}) {
    const std::vector<uint8_t> pixels(size_t(8 * 8 * channels), 200);
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* bytes = nullptr;
    unsigned long count = 0;
    jpeg_mem_dest(&info, &bytes, &count);
    info.image_width = info.image_height = 8;
    info.input_components = channels;
    info.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_CMYK;
    jpeg_set_defaults(&info);
    jpeg_start_compress(&info, TRUE);
    for (int y = 0; y < 8; ++y) {
      auto* row = const_cast<JSAMPROW>(&pixels[size_t(8 * y * channels)]);
      jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    writeBytes(path, std::string(reinterpret_cast<char*>(bytes), count));
    // Cut off within the pixels, the rest would be made up.
    writeBytes(folder.path("cut.jpg"), std::string(reinterpret_cast<char*>(bytes), count - 3));
    std::free(bytes);

    const auto image = Image::read(path, false, kAt);
    EXPECT_EQ(image->channels(), channels == 1 ? 1 : 3);
    const float expected = channels == 1 ? 200.0f / 255 : 200.0f / 255 * 200.0f / 255;
    EXPECT_NEAR(image->rgb(3, 5).y, expected, 1.5f / 255);
    // Versions of the library word it differently.
    EXPECT_NE(complaint(folder.path("cut.jpg"), kAt).find("remature end"), std::string::npos);
  }
}

// Scan lines of at least eight pixels are run-length encoded.
TEST(ReadImage, HdrScanLines) {
  const test::TemporaryFolder folder;
  std::vector<float> pixels(40 * 3 * 3);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = i % 120 < 60 ? 0.5f : float(i % 7 + 1);
  stbi_write_hdr(folder.path("a.hdr").c_str(), 40, 3, 3, pixels.data());
  const auto image = Image::read(folder.path("a.hdr"), false, kAt);
  for (int i = 0; i < 120; ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image->rgb(i % 40, i / 40)[c], pixels[3 * i + c], 8.0f / 128) << i;
}

TEST(ReadImage, HdrIsLinearWhateverIsAsked) {
  const test::TemporaryFolder folder;
  const std::vector<float> pixels = {1, 2, 4, 0.25f, 100, 50, 0, 0, 0, 1000, 500, 750};
  stbi_write_hdr(folder.path("a.hdr").c_str(), 2, 2, 3, pixels.data());
  const auto image = Image::read(folder.path("a.hdr"), true, kAt);
  ASSERT_EQ(image->channels(), 3);
  for (int i = 0; i < 4; ++i) {
    const float largest = std::max({pixels[3 * i], pixels[3 * i + 1], pixels[3 * i + 2]});  // shared exponent
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image->rgb(i % 2, i / 2)[c], pixels[3 * i + c], largest / 128) << i << " " << c;
  }
}

TEST(ReadImage, GreyAndAlpha) {
  const test::TemporaryFolder folder;
  const std::vector<uint8_t> grey = {0, 64, 128, 255}, greyAlpha = {10, 255, 20, 0, 30, 128, 40, 255};
  stbi_write_png(folder.path("grey.png").c_str(), 2, 2, 1, grey.data(), 2);
  stbi_write_png(folder.path("alpha.png").c_str(), 2, 2, 2, greyAlpha.data(), 4);
  const auto image = Image::read(folder.path("grey.png"), false, kAt);
  EXPECT_EQ(image->channels(), 1);
  EXPECT_FLOAT_EQ(image->scalar(0, 1), 128.0f / 255.0f);
  EXPECT_FLOAT_EQ(image->rgb(0, 1).y, 128.0f / 255.0f);
  const auto masked = Image::read(folder.path("alpha.png"), false, kAt);
  EXPECT_EQ(masked->channels(), 1);
  EXPECT_TRUE(masked->hasAlpha());
  EXPECT_FLOAT_EQ(masked->scalar(1, 1), 40.0f / 255.0f);
  EXPECT_FLOAT_EQ(masked->alpha(1, 0), 0.0f);
  EXPECT_FLOAT_EQ(masked->alpha(0, 1), 128.0f / 255.0f);
  EXPECT_FLOAT_EQ(masked->channel('a')->scalar(0, 1), 128.0f / 255.0f);
  EXPECT_FLOAT_EQ(image->channel('a')->scalar(0, 1), 1.0f);
  EXPECT_FLOAT_EQ(image->channel('g')->scalar(0, 1), 128.0f / 255.0f);
}

TEST(ReadImage, SixteenBitPngKeepsItsPrecision) {
  const test::TemporaryFolder folder;
  const std::vector<uint16_t> values = {0, 1, 257, 30001, 65534, 65535};
  writeBytes(folder.path("a.png"), png16(3, 2, values));
  const auto raw = Image::read(folder.path("a.png"), false, kAt),
             decoded = Image::read(folder.path("a.png"), true, kAt);
  ASSERT_EQ(raw->channels(), 1);
  for (int i = 0; i < 6; ++i) {
    const float stored = float(values[i]) / 65535.0f;
    EXPECT_NEAR(raw->scalar(i % 3, i / 3), stored, 1e-7f);
    EXPECT_NEAR(decoded->scalar(i % 3, i / 3), srgbDecode(stored), 1e-6f);
  }
}

TEST(ReadImage, ExrLayers) {
  const test::TemporaryFolder folder;
  const float zero[2] = {0, 0}, a[2] = {1, 2}, b[2] = {3, 4}, c[2] = {5, 6}, alpha[2] = {1, 0.5f};
  const ImageWindow window{2, 1, 0, 0, 2, 1};
  const auto read = [&](const std::vector<ImageChannel>& channels) {
    writeExr(folder.path("a.exr"), window, channels, {});
    return Image::read(folder.path("a.exr"), true, kAt);
  };
  // The layer without a name wins over one that sorts before it.
  auto image =
      read({{"AOV.R", zero}, {"AOV.G", zero}, {"AOV.B", zero}, {"R", a}, {"G", b}, {"B", c}, {"A", alpha}});
  EXPECT_EQ(image->rgb(1, 0), Rgb(2, 4, 6));
  EXPECT_FLOAT_EQ(image->alpha(1, 0), 128.0f / 255.0f);
  // Without one, the first that has colours.
  image = read({{"a.Z", zero}, {"b.R", a}, {"b.G", b}, {"b.B", c}});
  EXPECT_EQ(image->rgb(0, 0), Rgb(1, 3, 5));
  image = read({{"Y", b}});
  EXPECT_EQ(image->channels(), 1);
  EXPECT_EQ(image->scalar(1, 0), 4.0f);
  image = read({{"height", c}});
  EXPECT_EQ(image->scalar(1, 0), 6.0f);
}

TEST(ReadImage, GammaReplacesTheCurve) {
  const test::TemporaryFolder folder;
  stbi_write_png(folder.path("a.png").c_str(), 3, 2, 3, kRgb.data(), 9);
  const auto image = Image::read(folder.path("a.png"), false, kAt)->withGamma(2.2f);
  EXPECT_NEAR(image->rgb(1, 1).x, std::pow(128.0f / 255.0f, 2.2f), 1e-6f);
  const float bright[3] = {2, 3, 4};
  stbi_write_hdr(folder.path("a.hdr").c_str(), 1, 1, 3, bright);
  EXPECT_NEAR(Image::read(folder.path("a.hdr"), false, kAt)->withGamma(2.2f)->rgb(0, 0).z, 4.0f, 0.05f);
}

TEST(ReadImage, ComplaintsNameTheFileThePlaceAndTheReason) {
  const test::TemporaryFolder folder;
  const auto expect = [&](const std::string& name, const std::string& reason) {
    const std::string text = complaint(folder.path(name), kAt);
    EXPECT_NE(text.find("scene.xml:12:3"), std::string::npos) << text;
    EXPECT_NE(text.find(name), std::string::npos) << text;
    EXPECT_NE(text.find(reason), std::string::npos) << text;
  };
  expect("missing.png", "no such file");
  expect("", "it is a folder");
  writeBytes(folder.path("empty.png"), "");
  expect("empty.png", "empty");
  writeBytes(folder.path("text.png"), "this is no image at all, whatever its name says");
  expect("text.png", "not a readable");
  writeBytes(folder.path("magic.exr"), "\x76\x2f\x31\x01 and then nothing");
  expect("magic.exr", "magic.exr");
  // A header that promises 70000 x 2 pixels.
  stbi_write_png(folder.path("a.png").c_str(), 3, 2, 3, kRgb.data(), 9);
  std::string huge = bytesOf(folder.path("a.png"));
  huge.replace(16, 8, std::string("\0\1\x11\x70\0\0\0\2", 8));
  writeBytes(folder.path("huge.png"), huge);
  expect("huge.png", "70000");
  // A chunk of pixels that promises 1.3 GB.
  std::string chunk = bytesOf(folder.path("a.png"));
  chunk[chunk.find("IDAT") - 4] = 'P';
  writeBytes(folder.path("chunk.png"), chunk);
  expect("chunk.png", "a chunk at byte 33 announces");
}

// Truncated and damaged files are read or refused, never a crash, and never an image of a wrong size.
TEST(ReadImage, SurvivesDamage) {
  const test::TemporaryFolder folder;
  std::vector<uint8_t> pixels(16 * 16 * 3);
  std::vector<float> floats(pixels.size());
  std::mt19937 engine(5);
  for (uint8_t& p : pixels) p = uint8_t(engine());
  for (size_t i = 0; i < floats.size(); ++i) floats[i] = float(pixels[i]);
  stbi_write_png(folder.path("a.png").c_str(), 16, 16, 3, pixels.data(), 48);
  stbi_write_jpg(folder.path("a.jpg").c_str(), 16, 16, 3, pixels.data(), 90);
  stbi_write_tga(folder.path("a.tga").c_str(), 16, 16, 3, pixels.data());
  stbi_write_bmp(folder.path("a.bmp").c_str(), 16, 16, 3, pixels.data());
  stbi_write_hdr(folder.path("a.hdr").c_str(), 16, 16, 3, floats.data());
  writeExr(folder.path("a.exr"), {16, 16, 0, 0, 16, 16},
           {{"R", floats.data()}, {"G", floats.data(), true}, {"B", floats.data()}}, {});
  int refused = 0;
  const auto attempt = [&](const std::string& path, const std::string& bytes) {
    writeBytes(path, bytes);
    try {
      const auto image = Image::read(path, true, kAt);
      float sum = 0;
      for (int y = 0; y < image->height(); ++y) sum += image->scalar(image->width() - 1, y);
      EXPECT_GE(image->width() * image->height(), 1) << sum;
    } catch (const SceneError&) {
      ++refused;
    }
  };
  for (const char* name : {"a.png", "a.jpg", "a.tga", "a.bmp", "a.hdr", "a.exr"}) {
    const std::string whole = bytesOf(folder.path(name)), broken = folder.path(std::string("broken-") + name);
    ASSERT_GT(whole.size(), 100u);
    for (size_t i = 0; i < 40; ++i) attempt(broken, whole.substr(0, whole.size() * i / 40));
    for (int i = 0; i < 200; ++i) {
      std::string damaged = whole;
      // Half of the damage goes to the header, where sizes and counts are.
      const size_t range = i % 2 ? damaged.size() : std::min<size_t>(damaged.size(), 64);
      for (int k = 0; k < 1 + i % 4; ++k) damaged[engine() % range] = char(engine());
      attempt(broken, damaged);
    }
  }
  EXPECT_GT(refused, 200);
}

TEST(ImageFromMemory, ChecksItsSizes) {
  EXPECT_THROW(Image(0, 1, 1, {}), std::invalid_argument);
  EXPECT_THROW(Image(1, 1, 2, {0, 0}), std::invalid_argument);
  EXPECT_THROW(Image(2, 2, 1, {0, 0, 0}), std::invalid_argument);
  EXPECT_EQ(Image(2, 1, 1, {3, 5}).mean(), Rgb(4.0f));
}

}  // namespace
}  // namespace odis::render
