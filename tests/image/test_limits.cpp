// Headers that announce more than there is: refused before memory is spent on them.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstring>

#include "image/files.h"
#include "render/image/write.h"
#include "support/temporary_folder.h"

namespace odis::render {
namespace {

template <class T>
std::string raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// Memory in use at its highest so far, in bytes.
uint64_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return uint64_t(usage.ru_maxrss) * 1024;
}

TEST(ImageLimits, PixelsThatTheFileCannotHold) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("image");
  const uint64_t before = peakMemory();
  // An uncompressed TGA of 16384 x 16384 pixels, and one of them.
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[13] = tga[15] = 64;
  tga[16] = 32;
  writeBytes(path, tga + "abcd");
  EXPECT_NE(complaint(path).find("16384 x 16384 pixels, more than the file can hold"), std::string::npos);
  // A bitmap alike.
  writeBytes(path, "BM" + raw(uint32_t(58)) + raw(uint32_t(0)) + raw(uint32_t(54)) + raw(uint32_t(40)) +
                       raw(int32_t(16384)) + raw(int32_t(16384)) + raw(uint16_t(1)) + raw(uint16_t(24)) +
                       std::string(24, '\0') + "abcd");
  EXPECT_NE(complaint(path).find("more than the file can hold"), std::string::npos);
  // A scan line of HDR costs no more than itself.
  writeBytes(path, "#?RADIANCE\n\n-Y 16384 +X 16384\n\2\2\100");
  EXPECT_NE(complaint(path).find("ends early"), std::string::npos);
  EXPECT_LT(peakMemory() - before, uint64_t(64) << 20);
}

class ExrLimits : public testing::Test {
 protected:
  ExrLimits() {
    const std::vector<float> pixels(32 * 32, 0.5f);
    writeExr(m_path, {32, 32, 0, 0, 32, 32}, {{"Y", pixels.data()}}, {{"note", "a"}});
    m_file = bytesOf(m_path);
  }
  // The place of an attribute's value; its length is 4 bytes before.
  size_t valueOf(const std::string& name, const std::string& type) const {
    const std::string key = name + '\0' + type + '\0';
    return m_file.find(key) + key.size() + 4;
  }
  void overwrite(size_t at, const std::string& bytes) { m_file.replace(at, bytes.size(), bytes); }
  // Makes it a tiled image.
  void insertTiles(uint32_t width, uint32_t height) {
    overwrite(4, raw(uint32_t(2 | 0x200)));
    m_file.insert(valueOf("note", "string") + 1,
                  std::string("tiles\0tiledesc\0", 15) + raw(uint32_t(9)) + raw(width) + raw(height) + '\0');
  }
  std::string complaintNow() const {
    writeBytes(m_path, m_file);
    return complaint(m_path);
  }

  test::TemporaryFolder m_folder;
  std::string m_path = m_folder.path("a.exr"), m_file;
};

TEST_F(ExrLimits, SmallFilesAreRead) {
  EXPECT_EQ(complaintNow(), "");
}

TEST_F(ExrLimits, AttributeLongerThanTheFile) {
  overwrite(valueOf("note", "string") - 4, raw(uint32_t(2000000000)));
  EXPECT_NE(complaintNow().find("the header ends early"), std::string::npos) << complaintNow();
}

// OpenEXR would not skip what is too much and read on in its midst.
TEST_F(ExrLimits, AttributeOfAnotherLengthThanItsType) {
  const size_t at = valueOf("displayWindow", "box2i");
  overwrite(at - 4, raw(uint32_t(17)));
  m_file.insert(at + 16, 1, '\0');
  EXPECT_NE(complaintNow().find("type box2i has 17 bytes, expected 16"), std::string::npos) << complaintNow();
}

TEST_F(ExrLimits, MoreRowsThanTheFileHasOffsetsFor) {
  overwrite(valueOf("dataWindow", "box2i") + 12, raw(int32_t(60000)));
  EXPECT_NE(complaintNow().find("3751 groups of rows"), std::string::npos) << complaintNow();
}

TEST_F(ExrLimits, MoreTilesThanTheFileHasOffsetsFor) {
  insertTiles(1, 1);
  overwrite(valueOf("dataWindow", "box2i") + 8, raw(int32_t(16383)) + raw(int32_t(16383)));
  EXPECT_NE(complaintNow().find("268435456 tiles"), std::string::npos) << complaintNow();
}

// OpenEXR makes room for a row of tiles, however small the image.
TEST_F(ExrLimits, TilesMuchLargerThanTheImage) {
  insertTiles(2, 0x8000002);
  EXPECT_NE(complaintNow().find("its tiles are of 2 x 134217730 pixels"), std::string::npos)
      << complaintNow();
}

TEST_F(ExrLimits, SidesBeyondTheLimits) {
  overwrite(valueOf("dataWindow", "box2i"), raw(int32_t(-2147483647)));
  EXPECT_NE(complaintNow().find("65537 x 32 pixels"), std::string::npos) << complaintNow();
  overwrite(valueOf("dataWindow", "box2i"), raw(int32_t(32)));
  EXPECT_NE(complaintNow().find("0 x 32 pixels"), std::string::npos) << complaintNow();
}

}  // namespace
}  // namespace odis::render
