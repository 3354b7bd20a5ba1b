#include "render/image/copy_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <list>

#include "render/files/replace_file.h"
#include "render/image/exr_check.h"
#include "render/image/exr_streams.h"
#include "render/image/read_bytes.h"

namespace odis::render {

namespace {

// A part of the copy: its header, and the pixels of its channels in their own types.
class CopiedPart {
 public:
  CopiedPart(Imf::MultiPartInputFile& file, int index) : m_header(file.header(index)) {
    if (m_header.hasType() && Imf::isDeepData(m_header.type()))
      throw std::runtime_error("it has a part with deep pixels, expected flat ones");
    Imf::InputPart part(file, index);
    const Imath::Box2i& window = m_header.dataWindow();
    for (auto i = m_header.channels().begin(); i != m_header.channels().end(); ++i) {
      requireFullResolution(i.name(), i.channel().xSampling, i.channel().ySampling);
      add(i.name(), i.channel().type, std::vector<char>(pixelCount() * bytesOf(i.channel().type)));
    }
    part.setFrameBuffer(m_frame);
    part.readPixels(window.min.y, window.max.y);
    // The copy has rows.
    m_header.erase("tiles");
    m_header.lineOrder() = Imf::INCREASING_Y;
    if (m_header.hasType()) m_header.setType(Imf::SCANLINEIMAGE);
  }

  void remove(const std::string& channel) {
    Imf::ChannelList rest;
    Imf::FrameBuffer frame;
    for (auto i = m_header.channels().begin(); i != m_header.channels().end(); ++i)
      if (i.name() != channel) {
        rest.insert(i.name(), i.channel());
        frame.insert(i.name(), m_frame[i.name()]);
      }
    m_header.channels() = rest;
    m_frame = frame;
  }

  void set(const NewChannel& channel) {
    const Imf::Channel* like = m_header.channels().findChannel(channel.like);
    const bool isHalf = like && like->type == Imf::HALF;
    const void* source = channel.pixels.data();
    std::vector<half> halves;
    if (isHalf) source = (halves = toHalf(channel.pixels.data(), channel.pixels.size())).data();
    const Imf::PixelType type = isHalf ? Imf::HALF : Imf::FLOAT;
    std::vector<char> bytes(pixelCount() * bytesOf(type));
    std::memcpy(bytes.data(), source, bytes.size());
    m_header.channels().insert(channel.name, Imf::Channel(type));
    add(channel.name, type, std::move(bytes));
  }

  Imf::Header& header() { return m_header; }
  const Imf::FrameBuffer& frame() const { return m_frame; }
  int height() const { return m_header.dataWindow().max.y - m_header.dataWindow().min.y + 1; }

 private:
  static size_t bytesOf(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }
  size_t pixelCount() const {
    const Imath::Box2i& window = m_header.dataWindow();
    return size_t(window.max.x - window.min.x + 1) * size_t(height());
  }
  void add(const std::string& name, Imf::PixelType type, std::vector<char> bytes) {
    m_planes.push_back(std::move(bytes));
    m_frame.insert(name, Imf::Slice::Make(type, m_planes.back().data(), m_header.dataWindow()));
  }

  Imf::Header m_header;
  Imf::FrameBuffer m_frame;
  std::list<std::vector<char>> m_planes;  // a list: they must not move
};

std::list<CopiedPart> readParts(const std::string& path) {
  try {
    const std::vector<uint8_t> bytes = readImageBytes(path);
    checkExrHeaders(bytes);
    ByteStream stream(bytes);
    Imf::MultiPartInputFile file(stream);
    std::list<CopiedPart> parts;
    for (int i = 0; i < file.parts(); ++i) parts.emplace_back(file, i);
    return parts;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("cannot read \"{}\": {}", path, error.what()));
  }
}

}  // namespace

void copyExr(const std::string& from, const std::string& to, const ExrChanges& changes) {
  std::list<CopiedPart> parts = readParts(from);
  CopiedPart& changed = *std::next(parts.begin(), int64_t(changes.part));
  // Types are those of channels that may be replaced or removed.
  for (const NewChannel& channel : changes.channels) changed.set(channel);
  for (const std::string& name : changes.removed) changed.remove(name);
  for (const auto& [name, text] : changes.metadata)
    parts.front().header().insert(name, Imf::StringAttribute(text));

  std::vector<Imf::Header> headers;
  for (CopiedPart& part : parts) headers.push_back(part.header());
  replaceFile(to, [&](CheckedStream& target) {
    ExrStream stream(target);
    allowExrThreads();
    Imf::MultiPartOutputFile file(stream, headers.data(), int(headers.size()));
    int index = 0;
    for (const CopiedPart& part : parts) {
      Imf::OutputPart output(file, index++);
      output.setFrameBuffer(part.frame());
      output.writePixels(part.height());
    }
  });
}

}  // namespace odis::render
