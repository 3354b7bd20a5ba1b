// Reading JPEG by libjpeg-turbo.
#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>  // for jpeglib.h
#include <cstring>
#include <stdexcept>

#include <jerror.h>
#include <jpeglib.h>

#include "render/image/image.h"
#include "render/image/limits.h"

namespace odis::render {

namespace {

// The library ends a failure by a jump, so whoever calls it holds nothing that has to be destroyed.
struct Failure {
  jpeg_error_mgr manager;
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];
};

void onError(j_common_ptr info) {
  auto* failure = reinterpret_cast<Failure*>(info->err);
  failure->manager.format_message(info, failure->message);
  std::longjmp(failure->jump, 1);
}

// Warnings are ignored, apart from those of pixels that are missing.
void onMessage(j_common_ptr info, int level) {
  const int code = info->err->msg_code;
  if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) onError(info);
}

// Files of few bytes can hold so many refinements of a large image that reading them takes hours.
void onProgress(j_common_ptr info) {
  constexpr int kMaxScans = 500;
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMaxScans) return;
  auto* failure = reinterpret_cast<Failure*>(info->err);
  std::strcpy(failure->message, "more refinements than are of use");
  std::longjmp(failure->jump, 1);
}

class Decoder {
 public:
  explicit Decoder(const std::vector<uint8_t>& file) {
    m_info.err = jpeg_std_error(&m_failure.manager);
    m_failure.manager.error_exit = onError;
    m_failure.manager.emit_message = onMessage;
    m_progress.progress_monitor = onProgress;
    if (setjmp(m_failure.jump) != 0) {
      jpeg_destroy_decompress(&m_info);
      throw error();
    }
    jpeg_create_decompress(&m_info);
    m_info.progress = &m_progress;
    jpeg_mem_src(&m_info, file.data(), static_cast<unsigned long>(file.size()));
    jpeg_read_header(&m_info, TRUE);
  }
  ~Decoder() { jpeg_destroy_decompress(&m_info); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  int width() const { return int(m_info.image_width); }
  int height() const { return int(m_info.image_height); }
  // Chooses what the pixels become and returns their number of bytes: grey, RGB, or CMYK.
  int start() {
    if (setjmp(m_failure.jump) != 0) throw error();
    if (m_info.jpeg_color_space == JCS_CMYK || m_info.jpeg_color_space == JCS_YCCK)
      m_info.out_color_space = JCS_CMYK;
    else if (m_info.jpeg_color_space != JCS_GRAYSCALE)
      m_info.out_color_space = JCS_RGB;
    jpeg_start_decompress(&m_info);
    return m_info.output_components;
  }
  void readRow(uint8_t* row) {
    if (setjmp(m_failure.jump) != 0) throw error();
    jpeg_read_scanlines(&m_info, &row, 1);
  }

 private:
  std::runtime_error error() const { return std::runtime_error(fmt::format("JPEG: {}", m_failure.message)); }

  jpeg_decompress_struct m_info{};
  jpeg_progress_mgr m_progress{};
  Failure m_failure{};
};

}  // namespace

std::shared_ptr<Image> Image::readJpegPixels(const std::vector<uint8_t>& file, bool srgb) {
  Decoder decoder(file);
  const int width = decoder.width(), height = decoder.height();
  checkImageSize(width, height);
  // A block of 64 pixels takes a bit at least.
  if (uint64_t(width) * uint64_t(height) > uint64_t(file.size()) * (8 * 64))
    throw std::runtime_error(
        fmt::format("it announces {} x {} pixels, more than the file can hold", width, height));
  const size_t stored = size_t(decoder.start()), kept = stored == 1 ? 1 : 3;

  std::shared_ptr<Image> image(new Image);
  image->m_width = width;
  image->m_height = height;
  image->m_channels = int(kept);
  image->m_linear = false;
  image->decodeBytes(srgb);
  std::vector<uint8_t> row(size_t(width) * stored);
  for (int y = 0; y < height; ++y) {
    decoder.readRow(row.data());
    for (size_t x = 0; x < size_t(width); ++x) {
      const uint8_t* pixel = &row[stored * x];
      // Programs that write CMYK store how much ink is left out.
      const int black = stored == 4 ? pixel[3] : 255;
      for (size_t c = 0; c < kept; ++c) image->m_bytes.push_back(uint8_t((pixel[c] * black + 127) / 255));
    }
  }
  return image;
}

}  // namespace odis::render
