#include "learn/scenes/materials.h"

#include <fmt/format.h>

#include <algorithm>

namespace odis::learn {

namespace {

// Rougher than this a surface scatters light, below it is drawn perfectly smooth.
constexpr float kSmooth = 0.004f;

std::string rgb(const char* name, const Rgb& c) {
  return fmt::format("<rgb name=\"{}\" value=\"{}, {}, {}\"/>", name, c.x, c.y, c.z);
}
std::string number(const char* name, double value) {
  return fmt::format("<float name=\"{}\" value=\"{}\"/>", name, float(value));
}

}  // namespace

Rgb hue(double h, double saturation, double value) {
  Rgb result;
  for (int c = 0; c < 3; ++c) {
    // The three channels are trapezoids over the circle of hues.
    const double x = std::abs(std::fmod(h * 6 + (c == 0 ? 0 : c == 1 ? 4 : 2) + 12, 6.0) - 3) - 1;
    result[c] = float(value * (1 - saturation * (1 - std::clamp(x, 0.0, 1.0))));
  }
  return result;
}

std::string Materials::Base::xml(const char* name) const {
  if (file.empty()) return rgb(name, color);
  return fmt::format(
      "<texture type=\"bitmap\" name=\"{}\"><string name=\"filename\" value=\"{}\"/>"
      "<transform name=\"to_uv\"><scale x=\"{}\" y=\"{}\"/></transform></texture>",
      name, file, 1 / tile.x, 1 / tile.y);
}

Materials::Materials(Description& scene, const Assets& assets, Random random)
    : m_scene(scene), m_assets(assets), m_random(random) {
  m_gloss = m_random.pick({0.1, 0.3, 0.3, 0.5, 0.85});
  m_textured = m_random.pick({0.0, 0.35, 0.6, 0.9});
  m_saturation = m_random.pick({0.15, 0.4, 0.4, 0.7});
  m_brightness = m_random.pick({0.35, 0.6, 0.85, 1.0});
  m_hue = m_random.unit();
}

void Materials::setStyle(double gloss, double textured) {
  m_gloss = gloss;
  m_textured = textured;
}

float Materials::roughness() {
  const double u = m_random.unit();
  m_scene.roughness.push_back(float(u * u));
  return float(u * u);
}

MaterialId Materials::add(const std::string& bsdf) {
  // The identifier goes into the outermost element.
  const auto id = MaterialId(m_scene.materials.size());
  std::string xml = bsdf;
  xml.insert(xml.find(' '), fmt::format(" id=\"material-{}\"", id));
  m_scene.materials.push_back(xml);
  return id;
}

MaterialId Materials::addTwoSided(const std::string& bsdf) {
  return add("<bsdf type=\"twosided\">" + bsdf + "</bsdf>");
}

MaterialId Materials::finish(const Base& base, double gloss) {
  if (!m_random.chance(gloss)) {
    if (m_random.chance(0.15))
      return addTwoSided("<bsdf type=\"principled\">" + base.xml("base_color") +
                         number("roughness", std::sqrt(std::max(roughness(), 0.2f))) + "</bsdf>");
    return addTwoSided("<bsdf type=\"diffuse\">" + base.xml("reflectance") + "</bsdf>");
  }
  const float alpha = roughness();
  if (alpha < kSmooth)
    return addTwoSided("<bsdf type=\"plastic\">" + base.xml("diffuse_reflectance") + "</bsdf>");
  if (m_random.chance(0.25))  // whose roughness is the root of the facets'
    return addTwoSided("<bsdf type=\"principled\">" + base.xml("base_color") +
                       number("roughness", std::sqrt(alpha)) + number("specular", m_random.range(0.2, 0.9)) +
                       "</bsdf>");
  return addTwoSided("<bsdf type=\"roughplastic\"><string name=\"distribution\" value=\"ggx\"/>" +
                     number("alpha", alpha) + base.xml("diffuse_reflectance") + "</bsdf>");
}

std::string Materials::addFile(const std::string& bytes) {
  const std::string name = fmt::format("textures/{:03}.png", m_scene.files.size());
  m_scene.files.push_back({name, bytes});
  return name;
}

Materials::Base Materials::patterned(Pattern pattern, const Rgb& first, const Rgb& second) {
  const Texture texture = makeTexture(pattern, first, second, Random(m_random.bits()));
  return {Rgb(0.5f), addFile(texture.png), texture.tile};
}

Materials::Base Materials::photographed(bool vivid) {
  constexpr int kAttempts = 12;
  const std::string* path = nullptr;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    path = &m_random.pick(std::span<const std::string>(m_assets.textures()));
    if (vivid || !m_assets.isVivid(*path)) break;
  }
  return {Rgb(0.5f), addFile(m_assets.texture(*path)), Vec2(float(m_random.logRange(0.5, 2.5)))};
}

Materials::Base Materials::colored(double probability, std::initializer_list<Pattern> patterns,
                                   const Rgb& first, const Rgb& second) {
  if (!m_random.chance(probability * m_textured)) return {second, "", {1, 1}};
  if (!m_assets.textures().empty() && m_random.chance(0.5)) return photographed(false);
  return patterned(m_random.pick(patterns), first, second);
}

template <class Make>
MaterialId Materials::shared(std::vector<MaterialId>& pool, Make&& make) {
  if (!pool.empty() && m_random.chance(1 - 0.5 / double(pool.size())))
    return m_random.pick(std::span<const MaterialId>(pool));
  pool.push_back(make());
  return pool.back();
}

// A colour that goes with the scene: near its hue or opposite.
Rgb Materials::tint(double value) {
  const double h = m_hue + m_random.range(-0.12, 0.12) + (m_random.chance(0.3) ? 0.5 : 0);
  return hue(h - std::floor(h), m_saturation * m_random.unit(), value);
}

MaterialId Materials::wall() {
  return shared(m_wall, [&] {
    const double value = m_random.chance(0.15) ? m_random.range(0.08, 0.45) : m_random.range(0.55, 0.9);
    const Rgb color = tint(value * m_brightness) * 0.5f + Rgb(float(value * m_brightness)) * 0.5f;
    const double gloss = m_random.chance(0.2) ? m_gloss : 0.05;
    return finish(colored(0.4, {Pattern::bricks, Pattern::tiles, Pattern::stripes, Pattern::noise},
                          color * float(m_random.range(0.4, 0.9)), color),
                  gloss);
  });
}

MaterialId Materials::ceiling() {
  return shared(m_ceiling, [&] {
    return m_random.chance(0.85)
               ? matt(hue(m_hue, 0.05, m_random.range(0.6, 0.9) * (0.4 + 0.6 * m_brightness)))
               : wall();
  });
}

MaterialId Materials::floor() {
  return shared(m_floor, [&] {
    const Rgb brown = hue(m_random.range(0.04, 0.11), m_random.range(0.3, 0.75), m_random.range(0.12, 0.6));
    const Rgb color = m_random.chance(0.5) ? brown : tint(m_random.range(0.1, 0.75));
    return finish(colored(1.3,
                          {Pattern::planks, Pattern::planks, Pattern::tiles, Pattern::checks, Pattern::noise,
                           Pattern::marble},
                          color * float(m_random.range(0.2, 0.8)), color),
                  0.15 + 0.85 * m_gloss);
  });
}

MaterialId Materials::wood() {
  return shared(m_wood, [&] {
    const Rgb color = m_random.chance(0.25) ? tint(m_random.range(0.6, 0.85))  // painted
                                            : hue(m_random.range(0.04, 0.1), m_random.range(0.3, 0.8),
                                                  m_random.range(0.1, 0.6));
    return finish(colored(0.8, {Pattern::planks}, color * 0.6f, color), m_gloss);
  });
}

MaterialId Materials::fabric() {
  return shared(m_fabric, [&] {
    const Rgb color = tint(m_random.range(0.05, 0.8));
    const Base base = colored(0.5, {Pattern::stripes, Pattern::noise, Pattern::checks, Pattern::spots},
                              color * float(m_random.range(0.3, 0.8)), color);
    if (m_random.chance(0.3)) {
      return addTwoSided("<bsdf type=\"principled\">" + base.xml("base_color") + number("roughness", 0.9) +
                         number("sheen", m_random.unit()) + "</bsdf>");
    }
    return finish(base, 0);
  });
}

MaterialId Materials::lacquer() {
  return shared(m_lacquer, [&] {
    const bool grey = m_random.chance(0.4);
    const double h = m_random.unit(), value = m_random.range(0.04, 0.85);
    return finish({hue(h, grey ? 0.03 : m_random.range(0.2, 0.85), value), "", {1, 1}}, 0.3 + 0.7 * m_gloss);
  });
}

MaterialId Materials::metal() {
  return shared(m_metal, [&] { return metal(roughness()); });
}

MaterialId Materials::metal(float alpha) {
  const std::string material = fmt::format("<string name=\"material\" value=\"{}\"/>",
                                           m_random.pick({"Al", "Al", "Ag", "Cr", "Cu", "Au"}));
  if (alpha < kSmooth) return addTwoSided("<bsdf type=\"conductor\">" + material + "</bsdf>");
  return addTwoSided("<bsdf type=\"roughconductor\">" + material +
                     "<string name=\"distribution\" value=\"ggx\"/>" + number("alpha", alpha) + "</bsdf>");
}

MaterialId Materials::glass() {
  return shared(m_glass, [&] {
    const double ior = m_random.range(1.3, 1.8);
    const Rgb color = m_random.chance(0.6) ? Rgb(1.0f) : hue(m_random.unit(), m_random.range(0.1, 0.6), 1);
    const std::string shared = number("int_ior", ior) + rgb("specular_transmittance", color);
    const float alpha = m_random.chance(0.3) ? roughness() : 0;
    if (alpha < kSmooth) return add("<bsdf type=\"dielectric\">" + shared + "</bsdf>");
    return add("<bsdf type=\"roughdielectric\"><string name=\"distribution\" value=\"ggx\"/>" +
               number("alpha", alpha) + shared + "</bsdf>");
  });
}

MaterialId Materials::foliage() {
  return shared(m_foliage, [&] {
    return finish(
        {hue(m_random.range(0.17, 0.36), m_random.range(0.4, 0.8), m_random.range(0.08, 0.4)), "", {1, 1}},
        0.3 * m_gloss);
  });
}

MaterialId Materials::anything() {
  switch (m_random.weighted({2, 2, 4, 1.5, 0.7})) {
    case 0:
      return wood();
    case 1:
      return fabric();
    case 2:
      return lacquer();
    case 3:
      return metal();
    default:
      return glass();
  }
}

MaterialId Materials::picture() {
  const Rgb first = hue(m_random.unit(), m_random.unit(), m_random.range(0.1, 0.8)),
            second = hue(m_random.unit(), m_random.unit(), m_random.range(0.1, 0.9));
  Base base =
      !m_assets.textures().empty() && m_random.chance(0.4)
          ? photographed(true)
          : patterned(m_random.pick({Pattern::blocks, Pattern::blocks, Pattern::noise, Pattern::spots}),
                      first, second);
  return finish(base, 0.5 * m_gloss);
}

MaterialId Materials::mirror() {
  return addTwoSided("<bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/>" +
                     rgb("specular_reflectance", Rgb(float(m_random.range(0.85, 0.98)))) + "</bsdf>");
}

MaterialId Materials::pane() {
  return add("<bsdf type=\"thindielectric\"><float name=\"int_ior\" value=\"1.5\"/></bsdf>");
}

MaterialId Materials::water() {
  return add("<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"water\"/></bsdf>");
}

MaterialId Materials::sheer(float opacity) {
  return add("<bsdf type=\"mask\">" + number("opacity", opacity) +
             "<bsdf type=\"twosided\"><bsdf type=\"diffuse\">" +
             rgb("reflectance", tint(m_random.range(0.5, 0.9))) + "</bsdf></bsdf></bsdf>");
}

MaterialId Materials::matt(const Rgb& color) {
  return addTwoSided("<bsdf type=\"diffuse\">" + rgb("reflectance", color) + "</bsdf>");
}

MaterialId Materials::finished(const Rgb& color) {
  return finish({color, "", {1, 1}}, 0.2 + 0.6 * m_gloss);
}

MaterialId Materials::textured(const std::string& path) {
  return finish({Rgb(0.5f), addFile(m_assets.texture(path)), {1, 1}}, 0.2 + 0.6 * m_gloss);
}

}  // namespace odis::learn
