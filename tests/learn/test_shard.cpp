// The container of the data set: what is written comes back, and damage is found.
#include "learn/data/shard_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "render/files/replace_file.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

using nlohmann::json;
using odis::test::TemporaryFolder;

template <class T>
std::vector<T> allBytesOf(size_t count) {
  std::vector<T> values(count);
  auto* bytes = reinterpret_cast<uint8_t*>(values.data());
  for (size_t i = 0; i < count * sizeof(T); ++i) bytes[i] = uint8_t(i * 151 + 7);
  return values;
}

// A small shard of every type, with empty arrays.
std::string smallShard() {
  ShardWriter writer;
  const auto add = [&]<class T>(const std::string& name, const Shape& shape, const std::vector<T>& values) {
    writer.add(name, shape, std::span<const T>(values));
  };
  add("bytes", {3, 5}, allBytesOf<uint8_t>(15));
  add("words", {2, 3, 2}, allBytesOf<uint16_t>(12));
  add("longs", {4}, allBytesOf<uint32_t>(4));
  add("steps", {1, 2}, std::vector<int32_t>{std::numeric_limits<int32_t>::min(), -1});
  add("halves", {4}, std::vector<Half>{Half(1.5f), Half(-0.0f), Half::posInf(), Half::qNan()});
  add("one", {}, std::vector<uint8_t>{42});
  add("same", {100}, std::vector<uint16_t>(100, 7));
  add("nothing", {0}, std::vector<Half>());
  add("nothing/3", {3, 0}, std::vector<int32_t>());
  const TemporaryFolder folder;
  writer.write(folder.path("a.shard"), {{"name", "small"}, {"number", 0.1f}});
  return shardBytes(folder.path("a.shard"));
}

// The bits of all arrays, by name.
std::map<std::string, std::string> contentOf(const ShardReader& reader) {
  std::map<std::string, std::string> result;
  const auto add = [&](const std::string& name, const auto& values) {
    result[name].assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  };
  for (const auto& [name, entry] : reader.header().at("arrays").items()) {
    const std::string type = entry.at("type");
    if (type == "|u1") add(name, reader.read<uint8_t>(name));
    if (type == "<u2") add(name, reader.read<uint16_t>(name));
    if (type == "<u4") add(name, reader.read<uint32_t>(name));
    if (type == "<i4") add(name, reader.read<int32_t>(name));
    if (type == "<f2") add(name, reader.read<Half>(name));
  }
  return result;
}

size_t headerEnd(const std::string& bytes) {
  uint32_t length;
  std::memcpy(&length, bytes.data() + 12, 4);
  return 20 + length;
}

// The same shard with another header, whose length and CRC-32 are right.
std::string withHeader(const std::string& bytes, const std::string& header) {
  const uint32_t words[3] = {1, uint32_t(header.size()), crc32(header)};
  return "ODISDATA" + std::string(reinterpret_cast<const char*>(words), 12) + header +
         bytes.substr(headerEnd(bytes));
}

// Reads everything; what the error says, empty if there was none.
std::string errorOf(const std::string& bytes) {
  try {
    ShardReader("x.shard", bytes).verify();
  } catch (const ShardError& e) {
    return e.what();
  }
  return "";
}

TEST(Shard, ComesBackAsItWas) {
  const ShardReader reader("small", smallShard());
  EXPECT_EQ(reader.header().at("name"), "small");
  EXPECT_EQ(reader.header().at("number").get<float>(), 0.1f);
  EXPECT_EQ(reader.shape("words"), (Shape{2, 3, 2}));
  EXPECT_EQ(reader.shape("one"), Shape{});
  EXPECT_EQ(reader.read<uint8_t>("bytes"), allBytesOf<uint8_t>(15));
  EXPECT_EQ(reader.read<uint16_t>("words"), allBytesOf<uint16_t>(12));
  EXPECT_EQ(reader.read<uint32_t>("longs"), allBytesOf<uint32_t>(4));
  EXPECT_EQ(reader.read<int32_t>("steps"), (std::vector<int32_t>{std::numeric_limits<int32_t>::min(), -1}));
  const std::vector<Half> halves = reader.read<Half>("halves");
  const uint16_t bits[4] = {Half(1.5f).bits(), Half(-0.0f).bits(), Half::posInf().bits(),
                            Half::qNan().bits()};
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(halves[i].bits(), bits[i]);
  EXPECT_EQ(reader.read<uint8_t>("one"), std::vector<uint8_t>{42});
  EXPECT_TRUE(reader.read<Half>("nothing").empty());
  EXPECT_EQ(reader.shape("nothing/3"), (Shape{3, 0}));
  EXPECT_TRUE(reader.read<int32_t>("nothing/3").empty());
  EXPECT_EQ(reader.arrays().size(), 9u);
}

TEST(Shard, AnswersOnlyForWhatItHas) {
  const ShardReader reader("small", smallShard());
  EXPECT_THROW(reader.read<uint16_t>("bytes"), ShardError);
  EXPECT_THROW(reader.read<uint8_t>("byte"), ShardError);
  EXPECT_THROW(reader.shape(""), ShardError);
  EXPECT_EQ(readColumn<uint8_t>(reader, "bytes", 3, 5).size(), 15u);
  EXPECT_THROW(readColumn<uint8_t>(reader, "bytes", 14), ShardError);
  ShardWriter writer;
  const std::vector<uint16_t> six(6);
  EXPECT_THROW(writer.add("a", {5}, std::span(six)), std::logic_error);
  EXPECT_THROW(writer.add("a", {2, 0}, std::span(six)), std::logic_error);
  EXPECT_THROW(writer.add("a", {1ull << 63, 2, 3}, std::span(six)), std::logic_error);
}

// The header has a CRC-32, the content of each array an XXH64: ShardReader finds each bit that changes what
// is read. What it does not find are bits of a frame that leave its content as it is: one that Zstandard does
// not use, and whether a single byte is stored or repeated once. The CRC-32 of the whole file, which the
// manifest has, finds any single bit.
TEST(Shard, EveryFlippedBitIsFound) {
  const std::string bytes = smallShard();
  const auto content = contentOf(ShardReader("x", bytes));
  const uint32_t crc = crc32(bytes);
  size_t unfound = 0;
  for (size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
    ASSERT_NE(crc32(damaged), crc) << bit;
    if (!errorOf(damaged).empty()) continue;
    ++unfound;
    ASSERT_GE(bit / 8, headerEnd(bytes)) << "in the header";
    ASSERT_EQ(contentOf(ShardReader("x", damaged)), content) << "bit " << bit;
  }
  EXPECT_LE(unfound, 2 * content.size()) << "of " << 8 * bytes.size();
}

TEST(Shard, EveryTruncationIsFound) {
  const std::string bytes = smallShard();
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(ShardReader("x", bytes.substr(0, size)), ShardError) << size;
  EXPECT_THROW(ShardReader("x", bytes + '\0'), ShardError);
  EXPECT_THROW(ShardReader("/nowhere/x.shard"), ShardError);
}

// What opening a file as a shard says, whole or its header alone; empty if there was no error.
template <class Reader>
std::string openingErrorOf(const std::string& path) {
  try {
    const Reader reader(path);
  } catch (const ShardError& e) {
    return e.what();
  }
  return "";
}

TEST(ShardHeader, SaysWhatTheWholeFileSays) {
  const TemporaryFolder folder;
  const std::string bytes = smallShard(), path = folder.path("a.shard");
  const auto write = [&](const std::string& content) { std::ofstream(path, std::ios::binary) << content; };
  write(bytes);
  const ShardHeader header(path);
  const ShardReader whole(path);
  EXPECT_EQ(header.header(), whole.header());
  EXPECT_EQ(header.arrays(), whole.arrays());
  EXPECT_EQ(header.shape("words"), (Shape{2, 3, 2}));
  EXPECT_THROW(header.shape("word"), ShardError);
  // And finds the same faults.
  const auto expectSame = [&](const std::string& content) {
    write(content);
    const std::string error = openingErrorOf<ShardHeader>(path);
    ASSERT_NE(error, "");
    ASSERT_EQ(error, openingErrorOf<ShardReader>(path));
  };
  for (size_t size = 0; size < bytes.size(); ++size) expectSame(bytes.substr(0, size));
  expectSame(bytes + '\0');
  for (size_t i = 0; i < headerEnd(bytes); ++i) {
    std::string damaged = bytes;
    damaged[i] = char(damaged[i] ^ (1 << i % 8));
    expectSame(damaged);
  }
  EXPECT_NE(openingErrorOf<ShardHeader>(folder.path("none")).find("there is no such file"),
            std::string::npos);
  EXPECT_NE(openingErrorOf<ShardHeader>(folder.path("")), "");
}

// The arrays are a hole larger than most machines' memory.
TEST(ShardHeader, IsReadAlone) {
  constexpr uint64_t kHole = 1ull << 42;
  const TemporaryFolder folder;
  const std::string path = folder.path("a.shard");
  const json array = {{"type", "|u1"}, {"shape", {7}}, {"offset", 0}, {"bytes", kHole}};
  const std::string bytes = withHeader(smallShard(), json{{"arrays", {{"a", array}}}}.dump());
  std::ofstream(path, std::ios::binary) << bytes.substr(0, headerEnd(bytes));
  std::error_code error;
  std::filesystem::resize_file(path, headerEnd(bytes) + kHole, error);
  if (error) GTEST_SKIP() << "no file of 4 TiB here: " << error.message();
  EXPECT_EQ(ShardHeader(path).arrays().at(0).second, kHole);
}

TEST(Shard, HeadersThatLieAreErrors) {
  const std::string bytes = smallShard();
  const json good = ShardReader("x", bytes).header();
  ASSERT_EQ(errorOf(withHeader(bytes, good.dump())), "");
  const auto expectError = [&](const std::string& header, const std::string& message) {
    EXPECT_NE(errorOf(withHeader(bytes, header)).find(message), std::string::npos)
        << header << "\n"
        << errorOf(withHeader(bytes, header));
  };
  const auto expectArray = [&](const char* key, const json& value, const std::string& message) {
    json header = good;
    header["arrays"]["words"][key] = value;
    expectError(header.dump(), message);
  };
  for (const char* text : {"", "[", "[]", "{}", "1", "null", R"({"arrays":3})", R"({"arrays":{"a":3}})"})
    expectError(text, "x.shard: the header is not as expected");
  expectError(std::string(100'000, '['), "x.shard: the header is not as expected");
  expectArray("type", "<f8", "x.shard: words: found the type \"<f8\", expected |u1");
  expectArray("type", 3, "not as expected");
  expectArray("type", "<u4", "words: is damaged");
  expectArray("shape", {2, 3}, "words: is damaged");
  expectArray("shape", {13}, "words: is damaged");
  expectArray("shape", {2, 3, 0}, "words: is damaged");
  expectArray("shape", {1ull << 27, 2}, "words: is larger than any array may be");
  expectArray("shape", {1ull << 32, 1ull << 32}, "words: is larger");
  expectArray("shape", {1ull << 63, 2, 12}, "words: is larger");
  expectArray("shape", {-12}, "expected a whole number, found -12");
  expectArray("shape", {1e300}, "expected a whole number, found 1e+300");
  expectArray("shape", "many", "not as expected");
  expectArray("bytes", ~0ull, "words: is cut off");
  expectArray("bytes", -1, "expected a whole number, found -1");
  expectArray("bytes", 1e300, "expected a whole number, found 1e+300");
  expectArray("offset", 1e300, "expected a whole number, found 1e+300");
  expectArray("offset", ~0ull, "words: is cut off");
  expectArray("offset", bytes.size(), "words: is cut off");
  expectArray("offset", ~0ull - 20, "words: is cut off");
  json shorter = good;
  shorter["arrays"].erase("nothing/3");
  expectError(shorter.dump(), "bytes of arrays, expected");
  // The length of the header and the format.
  std::string damaged = bytes;
  damaged.replace(12, 4, "\xff\xff\xff\xff");
  EXPECT_NE(errorOf(damaged).find("is cut off"), std::string::npos);
  damaged = bytes;
  damaged[8] = 2;
  EXPECT_EQ(errorOf(damaged), "x.shard: found format 2, expected 1");
  EXPECT_NE(errorOf("ODISDATE" + bytes.substr(8)).find("expected it to begin with ODISDATA"),
            std::string::npos);
}

TEST(Shard, NothingIsLeftOfAFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("a.shard"));
  EXPECT_THROW(ShardWriter().write(folder.path("a.shard"), json::object()), render::WriteError);
  EXPECT_THROW(ShardWriter().write(folder.path("none/a.shard"), json::object()), render::WriteError);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path("")), {}), 1);
}

}  // namespace
}  // namespace odis::learn
