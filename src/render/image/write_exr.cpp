#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <stdexcept>

#include "render/files/replace_file.h"
#include "render/image/exr_streams.h"
#include "render/image/limits.h"
#include "render/image/write.h"

namespace odis::render {

std::vector<half> toHalf(const float* data, size_t count) {
  std::vector<half> result(count);
  for (size_t i = 0; i < count; ++i)
    result[i] =
        half(std::isfinite(data[i]) ? std::clamp(data[i], -float(HALF_MAX), float(HALF_MAX)) : data[i]);
  return result;
}

void allowExrThreads() {
  const size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  Imf::setGlobalThreadCount(threads > 1 ? int(threads) : 0);
}

void writeExr(const std::string& path, const ImageWindow& window, const std::vector<ImageChannel>& channels,
              const std::map<std::string, std::string>& metadata) {
  replaceFile(path, [&](CheckedStream& target) {
    if (window.width < 1 || window.height < 1 || window.width > kMaxImageSide ||
        window.height > kMaxImageSide || window.fullWidth < 1 || window.fullHeight < 1)
      throw std::runtime_error(fmt::format("an image cannot have {} x {} of {} x {} pixels", window.width,
                                           window.height, window.fullWidth, window.fullHeight));
    if (channels.empty()) throw std::runtime_error("an image without channels");
    const Imath::Box2i full({0, 0}, {window.fullWidth - 1, window.fullHeight - 1});
    const Imath::V2i origin(window.x, window.y);
    const Imath::Box2i crop(origin, {window.x + window.width - 1, window.y + window.height - 1});
    Imf::Header header(full, crop);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, text] : metadata) header.insert(name, Imf::StringAttribute(text));

    const size_t count = size_t(window.width) * size_t(window.height);
    std::vector<std::vector<half>> halves(channels.size());
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < channels.size(); ++i) {
      const ImageChannel& channel = channels[i];
      if (header.channels().findChannel(channel.name.c_str()))
        throw std::runtime_error(fmt::format("two channels with the name \"{}\"", channel.name));
      const Imf::PixelType type = channel.half ? Imf::HALF : Imf::FLOAT;
      header.channels().insert(channel.name, Imf::Channel(type));
      const void* data = channel.data;
      if (channel.half) {
        halves[i] = toHalf(channel.data, count);
        data = halves[i].data();
      }
      frame.insert(channel.name, Imf::Slice::Make(type, data, origin, window.width, window.height));
    }
    ExrStream stream(target);
    allowExrThreads();
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(window.height);
  });
}

}  // namespace odis::render
