// Reading OpenEXR: all channels for tools, or the colours of one layer for textures.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <stdexcept>

#include "render/image/exr_check.h"
#include "render/image/exr_streams.h"
#include "render/image/image.h"
#include "render/image/read_bytes.h"
#include "render/image/write.h"

namespace odis::render {

namespace {

// Reads the named channels of a file or a part as floats, each into its own plane. The planes grow with what
// has been read, so that a file that ends early costs no more memory than it has pixels.
template <class File>
std::vector<std::vector<float>> readPlanes(File& file, const std::vector<std::string>& names) {
  constexpr int kRows = 256;
  const Imf::Header& header = file.header();
  const Imath::Box2i& window = header.dataWindow();
  const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
  std::vector<std::vector<float>> planes(names.size());
  for (size_t i = 0; i < names.size(); ++i) {
    const Imf::Channel& channel = header.channels()[names[i].c_str()];
    requireFullResolution(names[i], channel.xSampling, channel.ySampling);
    planes[i].reserve(size_t(width) * size_t(height));
  }
  for (int row = 0; row < height; row += kRows) {
    const int end = std::min(row + kRows, height);
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < names.size(); ++i) {
      planes[i].resize(size_t(width) * size_t(end));
      frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, planes[i].data(), window.min, width, height));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y + row, window.min.y + end - 1);
  }
  return planes;
}

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
  bool hasFurtherParts() const { return Imf::isMultiPart(m_file.version()); }

  std::vector<std::vector<float>> read(const std::vector<std::string>& names) {
    return readPlanes(m_file, names);
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

static std::vector<std::string> channelNames(const Imf::Header& header) {
  std::vector<std::string> names;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) names.push_back(i.name());
  return names;
}

// Adds the channels of the parts that follow the first, those of another size or with deep pixels left out.
static void readFurtherParts(const std::vector<uint8_t>& bytes, ExrFile& result) {
  ByteStream stream(bytes);
  Imf::MultiPartInputFile file(stream);
  const Imath::Box2i& window = file.header(0).dataWindow();
  for (int index = 1; index < file.parts(); ++index) {
    const Imf::Header& header = file.header(index);
    if (header.dataWindow() != window || (header.hasType() && Imf::isDeepData(header.type()))) continue;
    Imf::InputPart part(file, index);
    const std::vector<std::string> names = channelNames(header);
    std::vector<std::vector<float>> planes = readPlanes(part, names);
    const std::string layer = (header.hasName() ? header.name() : std::to_string(index)) + ".";
    for (size_t i = 0; i < names.size(); ++i) {
      std::string name = names[i].starts_with(layer) ? names[i] : layer + names[i];
      if (!result.channels.emplace(name, std::move(planes[i])).second) continue;
      result.places[name] = {size_t(index), names[i]};
    }
  }
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
    const std::vector<std::string> names = channelNames(file.header());
    std::vector<std::vector<float>> planes = file.read(names);
    for (size_t i = 0; i < names.size(); ++i) {
      result.channels[names[i]] = std::move(planes[i]);
      result.places[names[i]] = {0, names[i]};
    }
    for (auto i = file.header().begin(); i != file.header().end(); ++i)
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
        result.metadata[i.name()] = text->value();
    if (file.hasFurtherParts()) readFurtherParts(bytes, result);
    return result;
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("cannot read \"{}\": {}", path, e.what()));
  }
}

}  // namespace odis::render
