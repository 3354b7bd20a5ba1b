// The code of stb_image and stb_image_write, compiled once, for the formats that scenes use.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // GCC 14 does not follow stb's PNG reader
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#include <stb_image.h>

// zlib packs better than what stb brings along. stb frees what it is given.
#include <zlib.h>

#include <cstdlib>

static unsigned char* packed(unsigned char* data, int size, int* packedSize, int quality) {
  uLongf length = compressBound(uLong(size));
  auto* result = static_cast<unsigned char*>(std::malloc(length));
  if (result && compress2(result, &length, data, uLong(size), quality) != Z_OK) {
    std::free(result);
    result = nullptr;
  }
  *packedSize = int(length);
  return result;
}
#define STBIW_ZLIB_COMPRESS packed
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
