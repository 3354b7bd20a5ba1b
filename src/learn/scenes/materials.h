// What surfaces of a scene are made of. A scene has a style: how glossy, textured, colourful and dark it is.
#pragma once

#include "learn/scenes/assets.h"
#include "learn/scenes/description.h"
#include "learn/scenes/random.h"
#include "learn/scenes/textures.h"

namespace odis::learn {

// A colour by hue (0 to 1), saturation and brightness of its strongest channel, linear.
Rgb hue(double hue, double saturation, double value);

class Materials {
 public:
  Materials(Description& scene, const Assets& assets, Random random);

  // Each is one that the scene has already, or a new one.
  MaterialId wall();
  MaterialId ceiling();
  MaterialId floor();
  MaterialId wood();
  MaterialId fabric();
  MaterialId lacquer();  // painted or plastic things
  MaterialId metal();
  MaterialId glass();
  MaterialId foliage();
  MaterialId anything();
  // One of its own.
  MaterialId picture();
  MaterialId mirror();
  MaterialId pane();  // thin window glass
  MaterialId water();
  MaterialId sheer(float opacity);  // lets the rest of the light straight through
  MaterialId matt(const Rgb& color);
  // A surface of this colour as glossy as the scene's style makes it.
  MaterialId finished(const Rgb& color);
  // An image of the user's by the mesh's own coordinates.
  MaterialId textured(const std::string& path);
  // A metal of this roughness (root mean square slope), a mirror if it is next to zero.
  MaterialId metal(float alpha);

  // From 0 to 1: the share of surfaces that are glossy, and of those that carry a texture.
  void setStyle(double gloss, double textured);
  float roughness();  // the square of a uniform number, as drawn and kept in the description

 private:
  struct Base {
    Rgb color;
    std::string file;  // "" if it is plain
    Vec2 tile{1, 1};
    std::string xml(const char* name) const;
  };
  MaterialId add(const std::string& bsdf);
  MaterialId addTwoSided(const std::string& bsdf);
  MaterialId finish(const Base& base, double gloss);
  Base patterned(Pattern pattern, const Rgb& first, const Rgb& second);
  // One of the user's images; walls and things avoid those that are `vivid`.
  Base photographed(bool vivid);
  Base colored(double probability, std::initializer_list<Pattern> patterns, const Rgb& first,
               const Rgb& second);
  std::string addFile(const std::string& bytes);
  // One of the pool, or a new one: the fewer there are, the likelier.
  template <class Make>
  MaterialId shared(std::vector<MaterialId>& pool, Make&& make);
  Rgb tint(double value);

  Description& m_scene;
  const Assets& m_assets;
  Random m_random;
  double m_gloss = 0, m_textured = 0, m_saturation = 0, m_brightness = 0, m_hue = 0;
  std::vector<MaterialId> m_floor, m_wall, m_ceiling, m_wood, m_fabric, m_lacquer, m_metal, m_glass,
      m_foliage;
};

}  // namespace odis::learn
