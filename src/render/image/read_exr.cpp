// Reading OpenEXR: all channels for tools, or the colours of one layer for textures.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

#include "render/image/exr_check.h"
#include "render/image/image.h"
#include "render/image/read_bytes.h"
#include "render/image/write.h"

namespace odis::render {

namespace {

// A file in memory, as OpenEXR reads one.
class ByteStream final : public Imf::IStream {
 public:
  explicit ByteStream(const std::vector<uint8_t>& bytes) : IStream("image"), m_bytes(bytes) {}

  bool read(char target[], int count) override {
    if (count < 0 || m_at > m_bytes.size() || size_t(count) > m_bytes.size() - m_at)
      throw std::runtime_error("the file ends early");
    std::memcpy(target, m_bytes.data() + m_at, size_t(count));
    m_at += uint64_t(count);
    return m_at < m_bytes.size();
  }
  uint64_t tellg() override { return m_at; }
  void seekg(uint64_t at) override { m_at = at; }

 private:
  const std::vector<uint8_t>& m_bytes;
  uint64_t m_at = 0;
};

// An open file whose headers have passed the checks that protect our memory.
class CheckedExr {
 public:
  explicit CheckedExr(const std::vector<uint8_t>& file)
      : m_stream((checkExrHeaders(file), file)), m_file(m_stream) {
    const Imath::Box2i& window = m_file.header().dataWindow();
    m_width = window.max.x - window.min.x + 1;
    m_height = window.max.y - window.min.y + 1;
  }

  const Imf::Header& header() const { return m_file.header(); }
  int width() const { return m_width; }
  int height() const { return m_height; }

  // Reads the named channels as floats, each into its own plane. The planes grow with what has been read, so
  // that a file that ends early costs no more memory than it has pixels.
  std::vector<std::vector<float>> read(const std::vector<std::string>& names) {
    constexpr int kRows = 256;
    std::vector<std::vector<float>> planes(names.size());
    for (size_t i = 0; i < names.size(); ++i) {
      const Imf::Channel& channel = header().channels()[names[i].c_str()];
      if (channel.xSampling != 1 || channel.ySampling != 1)
        throw std::runtime_error(fmt::format(
            "the channel \"{}\" has fewer samples than pixels; expected full resolution (convert the file "
            "from luminance and chroma to RGB)",
            names[i]));
      planes[i].reserve(size_t(m_width) * size_t(m_height));
    }
    const Imath::V2i origin = header().dataWindow().min;
    for (int row = 0; row < m_height; row += kRows) {
      const int end = std::min(row + kRows, m_height);
      Imf::FrameBuffer frame;
      for (size_t i = 0; i < names.size(); ++i) {
        planes[i].resize(size_t(m_width) * size_t(end));
        frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, planes[i].data(), origin, m_width, m_height));
      }
      m_file.setFrameBuffer(frame);
      m_file.readPixels(origin.y + row, origin.y + end - 1);
    }
    return planes;
  }

 private:
  ByteStream m_stream;
  Imf::InputFile m_file;
  int m_width = 0, m_height = 0;
};

// The part of a channel's name up to and with the last dot: "albedo." of "albedo.R".
std::string layerOf(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot + 1);
}

}  // namespace

std::shared_ptr<Image> Image::readExrPixels(const std::vector<uint8_t>& bytes) {
  CheckedExr file(bytes);
  const Imf::ChannelList& list = file.header().channels();
  const auto has = [&](const std::string& name) { return list.findChannel(name.c_str()) != nullptr; };

  // The layer without a name sorts first if it exists, then the others in the order of the file.
  std::vector<std::string> layers{""};
  for (auto i = list.begin(); i != list.end(); ++i) layers.push_back(layerOf(i.name()));
  std::vector<std::string> names;
  std::string layer;
  for (const std::string& candidate : layers) {
    layer = candidate;
    if (has(layer + "R") && has(layer + "G") && has(layer + "B"))
      names = {layer + "R", layer + "G", layer + "B"};
    else if (has(layer + "Y"))
      names = {layer + "Y"};
    if (!names.empty()) break;
  }
  if (names.empty() &&
      list.begin() != list.end()) {  // no colours: a file of one channel is a mask or a height
    layer = layerOf(list.begin().name());
    names = {list.begin().name()};
  }
  if (names.empty()) throw std::runtime_error("the EXR file has no channels");
  if (has(layer + "RY") || has(layer + "BY"))
    throw std::runtime_error("the EXR file stores luminance and chroma; expected RGB or a single channel");

  const size_t channels = names.size();
  const bool withAlpha = has(layer + "A") && names[0] != layer + "A";
  if (withAlpha) names.push_back(layer + "A");
  const std::vector<std::vector<float>> planes = file.read(names);

  std::shared_ptr<Image> image(new Image);
  image->m_width = file.width();
  image->m_height = file.height();
  image->m_channels = int(channels);
  const size_t count = planes[0].size();
  image->m_floats.resize(count * channels);
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < channels; ++c) image->m_floats[channels * i + c] = planes[c][i];
  if (withAlpha) {
    bool opaque = true;
    image->m_alpha.resize(count);
    for (size_t i = 0; i < count; ++i) {
      const float alpha = planes.back()[i];
      image->m_alpha[i] = alpha > 0 ? uint8_t(std::min(alpha, 1.0f) * 255.0f + 0.5f) : uint8_t(0);
      opaque &= image->m_alpha[i] == 255;
    }
    if (opaque) image->m_alpha.clear();
  }
  return image;
}

ExrFile readExr(const std::string& path) {
  try {
    const std::vector<uint8_t> bytes = readImageBytes(path);
    CheckedExr file(bytes);
    const Imath::Box2i &data = file.header().dataWindow(), &display = file.header().displayWindow();
    ExrFile result;
    result.window = {display.max.x - display.min.x + 1,
                     display.max.y - display.min.y + 1,
                     data.min.x - display.min.x,
                     data.min.y - display.min.y,
                     file.width(),
                     file.height()};
    std::vector<std::string> names;
    for (auto i = file.header().channels().begin(); i != file.header().channels().end(); ++i)
      names.push_back(i.name());
    std::vector<std::vector<float>> planes = file.read(names);
    for (size_t i = 0; i < names.size(); ++i) result.channels[names[i]] = std::move(planes[i]);
    for (auto i = file.header().begin(); i != file.header().end(); ++i)
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
        result.metadata[i.name()] = text->value();
    return result;
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("cannot read \"{}\": {}", path, e.what()));
  }
}

}  // namespace odis::render
