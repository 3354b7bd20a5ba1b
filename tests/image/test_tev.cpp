// The client of tev against a socket that listens here: every byte of the packets, as tev's Ipc.cpp reads
// them.
#include <gtest/gtest.h>

#include <cstring>

#include "render/image/tev.h"
#include "support/listener.h"

namespace odis::render {
namespace {

using test::Listener;

class Reader {
 public:
  explicit Reader(const std::string& bytes) : m_bytes(bytes) {}
  template <class T>
  T get() {
    T value{};
    if (m_at + sizeof value > m_bytes.size()) throw std::runtime_error("the stream ended early");
    std::memcpy(&value, m_bytes.data() + m_at, sizeof value);
    m_at += sizeof value;
    return value;
  }
  std::string text() {
    const std::string result = m_bytes.c_str() + m_at;
    m_at += result.size() + 1;
    return result;
  }
  size_t at() const { return m_at; }
  bool atEnd() const { return m_at == m_bytes.size(); }

 private:
  const std::string& m_bytes;
  size_t m_at = 0;
};

void expectCreate(Reader& reader, const std::string& name, int width, int height) {
  const size_t begin = reader.at();
  const uint32_t size = reader.get<uint32_t>();
  EXPECT_EQ(reader.get<char>(), 4);
  reader.get<char>();  // whether to grab the focus
  EXPECT_EQ(reader.text(), name);
  EXPECT_EQ(reader.get<int32_t>(), width);
  EXPECT_EQ(reader.get<int32_t>(), height);
  EXPECT_EQ(reader.get<int32_t>(), 3);
  for (const char* channel : {"R", "G", "B"}) EXPECT_EQ(reader.text(), channel);
  EXPECT_EQ(reader.at() - begin, size);
}

void expectUpdate(Reader& reader, const std::string& name, int width, int height,
                  const std::vector<Rgb>& pixels) {
  const size_t begin = reader.at();
  const uint32_t size = reader.get<uint32_t>();
  EXPECT_EQ(reader.get<char>(), 6);
  EXPECT_EQ(reader.get<char>(), 0);
  EXPECT_EQ(reader.text(), name);
  EXPECT_EQ(reader.get<int32_t>(), 3);
  for (const char* channel : {"R", "G", "B"}) EXPECT_EQ(reader.text(), channel);
  for (int expected : {0, 0, width, height}) EXPECT_EQ(reader.get<int32_t>(), expected);
  for (int64_t expected : {0, 1, 2, 3, 3, 3}) EXPECT_EQ(reader.get<int64_t>(), expected);
  for (const Rgb& pixel : pixels)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(reader.get<float>(), pixel[c]);
  EXPECT_EQ(reader.at() - begin, size);
}

TEST(TevClient, CreatesThenUpdates) {
  Listener listener;
  listener.start();
  const std::vector<Rgb> pixels = {{1, 2, 3},    {4, 5, 6},  {7, 8, 9},
                                   {10, 11, 12}, {-1, 0, 1}, {0.5f, 0.25f, 1e10f}};
  {
    TevClient client{TevAddress(listener.address())};
    client.send("a", 3, 2, pixels.data());
    client.send("a", 3, 2, pixels.data());
    client.send("a", 2, 3, pixels.data());
  }
  Reader reader(listener.received());
  expectCreate(reader, "a", 3, 2);
  expectUpdate(reader, "a", 3, 2, pixels);
  expectUpdate(reader, "a", 3, 2, pixels);
  // A new size: the old image is closed, a new one is made.
  EXPECT_EQ(reader.get<uint32_t>(), 7u);
  EXPECT_EQ(reader.get<char>(), 2);
  EXPECT_EQ(reader.text(), "a");
  expectCreate(reader, "a", 2, 3);
  expectUpdate(reader, "a", 2, 3, pixels);
  EXPECT_TRUE(reader.atEnd());
}

TEST(TevClient, SaysWhyItCannotConnect) {
  const std::string address = test::closedAddress();
  try {
    TevClient client{TevAddress(address)};
    FAIL() << "connected to nobody";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find(address), std::string::npos) << e.what();
  }
  for (const char* wrong : {"localhost:", "localhost:tev", "localhost:0", "localhost:65536", "localhost:-1"})
    EXPECT_THROW(TevAddress{wrong}, std::runtime_error) << wrong;
}

}  // namespace
}  // namespace odis::render
