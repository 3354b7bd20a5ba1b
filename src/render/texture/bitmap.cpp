// Bitmap texture: an image file, interpolated.
//
//   filename      string     PNG, JPEG, TGA, BMP, HDR or EXR; relative to the scene file
//   filter_type   string     bilinear (default) or nearest; trilinear and ewa of Mitsuba 0.6 mean bilinear,
//                            since a path tracer filters by its samples
//   wrap_mode     string     repeat (default), clamp, mirror; zero and one of 0.6; wrap_mode_u, wrap_mode_v
//                            for one axis
//   raw           boolean    true: the numbers of the file are used as they are (normal maps, roughness);
//                            default false: 8- and 16-bit files are decoded from sRGB
//   gamma         number     Mitsuba 0.6: 1 means raw, -1 (default) sRGB, another value a power curve
//   channel       string     Mitsuba 0.6: r, g, b or a, to use one channel alone
//   to_uv         transform  applied to uv before the look-up; uscale, vscale, uoffset, voffset of 0.6
//
// `accel` and `format` of Mitsuba 3 speak of its memory and mean nothing here, nor do 0.6's `max_anisotropy`
// and `cache`. The conventions are Mitsuba 3's: uv = (0, 0) is the corner of the first pixel of the first
// (top) row, v grows downwards in the image, texel centres lie at half-integers. Shapes flip v where their
// format asks for it.
#include "render/texture/bitmap.h"

#include "render/scene/builder.h"

namespace odis::render {

namespace {

// Texel coordinates that fit an int; NaN and the absurd become the origin.
float tame(float x) {
  return std::abs(x) < 1e9f ? x : 0.0f;
}

WrapMode readWrapMode(const Properties& node, const std::string& name, WrapMode fallback) {
  const std::string mode = node.word(name, "repeat|clamp|mirror|zero|one", "");
  node.describeFallback(name, name == "wrap_mode" ? "repeat" : "wrap_mode");
  if (mode == "repeat") return WrapMode::repeat;
  if (mode == "clamp") return WrapMode::clamp;
  if (mode == "mirror") return WrapMode::mirror;
  if (mode == "zero") return WrapMode::zero;
  if (mode == "one") return WrapMode::one;
  return fallback;
}

std::shared_ptr<const Image> readImage(const Properties& node, Builder& builder) {
  const std::string fileName = node.string("filename"), channel = node.word("channel", "r|g|b|a", "");
  node.describeFallback("channel", "all");
  const SourceLocation& at = node.placeOf("filename");
  const std::string path = builder.resolvePath(fileName, at);
  const float gamma = node.number("gamma", kGammaRange, -1.0f);
  const bool raw = node.boolean("raw", false) || gamma == 1.0f;
  const bool power = gamma > 0.0f && !raw;
  std::shared_ptr<const Image> image = builder.image(path, !raw && !power, at);
  if (power) image = image->withGamma(gamma);
  return channel.empty() ? image : image->channel(channel[0]);
}

}  // namespace

// Four texels, by wrapped indices, and where uv lies between their centres.
struct BitmapTexture::Patch {
  int x0, x1, y0, y1;
  float fx, fy;
};

BitmapTexture::BitmapTexture(std::shared_ptr<const Image> image, const Options& options)
    : m_image(std::move(image)), m_options(options), m_mean(m_image->mean()) {
  const auto bordered = [](WrapMode mode) { return mode == WrapMode::zero || mode == WrapMode::one; };
  m_constant =
      m_image->width() == 1 && m_image->height() == 1 && !bordered(options.wrapU) && !bordered(options.wrapV);
}

Vec2 BitmapTexture::range() const {
  Vec2 result(INFINITY, -INFINITY);
  for (int y = 0; y < m_image->height(); ++y)
    for (int x = 0; x < m_image->width(); ++x) {
      const Rgb c = m_image->rgb(x, y);
      result.x = std::min({result.x, c.x, c.y, c.z});
      result.y = std::max({result.y, c.x, c.y, c.z});
    }
  return result;
}

BitmapTexture::Patch BitmapTexture::patch(const Vec2& uv) const {
  const int width = m_image->width(), height = m_image->height();
  const Vec2 st = m_options.toUv.apply(uv);
  const float x = tame(st.x * float(width) - 0.5f), y = tame(st.y * float(height) - 0.5f);
  const int x0 = floorOf(x), y0 = floorOf(y);
  return {wrap(x0, width, m_options.wrapU),
          wrap(x0 + 1, width, m_options.wrapU),
          wrap(y0, height, m_options.wrapV),
          wrap(y0 + 1, height, m_options.wrapV),
          x - float(x0),
          y - float(y0)};
}

template <class T, class Fetch>
T BitmapTexture::texel(int x, int y, Fetch&& fetch) const {
  if (x >= 0 && y >= 0) return fetch(x, y);
  return T((x < 0 ? x : y) == kOneTexel ? 1.0f : 0.0f);
}

template <class T, class Fetch>
T BitmapTexture::interpolate(const Vec2& uv, Fetch&& fetch) const {
  if (m_options.nearest) {
    const int width = m_image->width(), height = m_image->height();
    const Vec2 st = m_options.toUv.apply(uv);
    const int x = floorOf(tame(st.x * float(width))), y = floorOf(tame(st.y * float(height)));
    return texel<T>(wrap(x, width, m_options.wrapU), wrap(y, height, m_options.wrapV), fetch);
  }
  const Patch p = patch(uv);
  const T top = texel<T>(p.x0, p.y0, fetch) * (1 - p.fx) + texel<T>(p.x1, p.y0, fetch) * p.fx;
  const T bottom = texel<T>(p.x0, p.y1, fetch) * (1 - p.fx) + texel<T>(p.x1, p.y1, fetch) * p.fx;
  return top * (1 - p.fy) + bottom * p.fy;
}

Rgb BitmapTexture::rgb(const Vec2& uv) const {
  if (!m_options.nearest) {
    const Patch p = patch(uv);
    if (std::min({p.x0, p.x1, p.y0, p.y1}) >= 0) return m_image->bilinear(p.x0, p.x1, p.y0, p.y1, p.fx, p.fy);
  }
  return interpolate<Rgb>(uv, [&image = *m_image](int x, int y) { return image.rgb(x, y); });
}

float BitmapTexture::scalar(const Vec2& uv) const {
  return interpolate<float>(uv, [&image = *m_image](int x, int y) { return image.scalar(x, y); });
}

Vec2 BitmapTexture::gradient(const Vec2& uv) const {
  if (m_options.nearest) return {0.0f, 0.0f};
  const auto fetch = [&image = *m_image](int x, int y) { return image.scalar(x, y); };
  const Patch p = patch(uv);
  const float f00 = texel<float>(p.x0, p.y0, fetch), f10 = texel<float>(p.x1, p.y0, fetch);
  const float f01 = texel<float>(p.x0, p.y1, fetch), f11 = texel<float>(p.x1, p.y1, fetch);
  const Vec2 perTexel(lerp(p.fy, f10 - f00, f11 - f01), lerp(p.fx, f01 - f00, f11 - f10));
  return m_options.toUv.pullBack(
      {perTexel.x * float(m_image->width()), perTexel.y * float(m_image->height())});
}

TexturePtr makeBitmapTexture(const Properties& node, Builder& builder) {
  BitmapTexture::Options options;
  const WrapMode both = readWrapMode(node, "wrap_mode", WrapMode::repeat);
  options.wrapU = readWrapMode(node, "wrap_mode_u", both);
  options.wrapV = readWrapMode(node, "wrap_mode_v", both);
  options.nearest = node.word("filter_type", "bilinear|nearest|trilinear|ewa", "bilinear") == "nearest";
  options.toUv = readUvTransform(node);
  // Known, and without a meaning here: asking keeps them out of the list of unknown parameters.
  for (const char* name : {"accel", "format", "max_anisotropy", "cache"})
    if (const auto i = node.parameters.find(name); i != node.parameters.end()) i->second.queried = true;
  return std::make_shared<BitmapTexture>(readImage(node, builder), options);
}

}  // namespace odis::render
