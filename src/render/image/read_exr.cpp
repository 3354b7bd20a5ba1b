// Reading OpenEXR: all channels for tools, or the colours of one layer for textures.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <mutex>
#include <stdexcept>

#include "render/image/image.h"
#include "render/image/limits.h"
#include "render/image/write.h"

namespace odis::render {

namespace {

// An open file whose header has passed the checks that protect our memory.
class CheckedExr {
 public:
  explicit CheckedExr(const std::string& path) : m_file((limitSides(), path.c_str())) {
    const Imath::Box2i& window = m_file.header().dataWindow();
    m_width = window.max.x - window.min.x + 1;
    m_height = window.max.y - window.min.y + 1;
    checkImageSize(m_width, m_height);
  }

  const Imf::Header& header() const { return m_file.header(); }
  int width() const { return m_width; }
  int height() const { return m_height; }

  // Reads the named channels as floats, each into its own plane.
  std::vector<std::vector<float>> read(const std::vector<std::string>& names) {
    std::vector<std::vector<float>> planes(names.size());
    const Imath::V2i origin = header().dataWindow().min;
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < names.size(); ++i) {
      const Imf::Channel& channel = header().channels()[names[i].c_str()];
      if (channel.xSampling != 1 || channel.ySampling != 1)
        throw std::runtime_error(fmt::format(
            "the channel \"{}\" has fewer samples than pixels; expected full resolution (convert the file "
            "from luminance and chroma to RGB)",
            names[i]));
      planes[i].assign(size_t(m_width) * size_t(m_height), 0.0f);
      frame.insert(names[i], Imf::Slice::Make(Imf::FLOAT, planes[i].data(), origin, m_width, m_height));
    }
    m_file.setFrameBuffer(frame);
    m_file.readPixels(header().dataWindow().min.y, header().dataWindow().max.y);
    return planes;
  }

 private:
  static void limitSides() {
    static std::once_flag once;
    std::call_once(once, [] { Imf::Header::setMaxImageSize(kMaxImageSide, kMaxImageSide); });
  }

  Imf::InputFile m_file;
  int m_width = 0, m_height = 0;
};

// The part of a channel's name up to and with the last dot: "albedo." of "albedo.R".
std::string layerOf(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot + 1);
}

}  // namespace

std::shared_ptr<Image> Image::readExrPixels(const std::string& path) {
  CheckedExr file(path);
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
    CheckedExr file(path);
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
