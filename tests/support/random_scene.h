// Scenes drawn at random, of everything that a scene can hold, nested in every way: seen from both sides,
// tiny and large, near the origin and far from it.
#pragma once

#include "support/draws.h"
#include "support/random_scene_files.h"

namespace odis::test {

// Writes a scene of one draw. Files that it refers to lie in `files`.
class RandomScene {
 public:
  RandomScene(Draws& draws, const SceneFiles& files) : m_draws(draws), m_files(files) {
    m_scale = m_draws.chance(0.5) ? 1 : m_draws.pick({1e-4, 0.01, 100.0, 1e4});
    // How far from the origin, in sizes of the scene.
    const double far = m_draws.chance(0.6) ? 0 : m_draws.pick({10.0, 1e3, 1e5});
    for (double& x : m_origin) x = far * m_scale * m_draws.between(-1, 1);
  }

  std::string text() {
    std::string body = integrator();
    const int shapes = 1 + int(m_draws.below(5)), lights = int(m_draws.below(3));
    const bool sensorInShape = m_draws.chance(0.05);
    if (!sensorInShape) body += sensor();
    for (int i = 0; i < shapes; ++i) body += shape(i == 0 && sensorInShape ? irradianceMeter() : "");
    for (int i = 0; i < lights; ++i) body += light();
    if (m_draws.chance(0.5)) body += "<emitter type='constant'>" + color("radiance", 2) + "</emitter>";
    return "<scene version='" + m_draws.pick<std::string>({"3.0.0", "3.0.0", "0.6.0"}) + "'>" + body +
           "</scene>";
  }

 private:
  using Text = std::string;

  static Text number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", x);
    return text;
  }
  static Text element(const Text& tag, const Text& name, const Text& value) {
    return "<" + tag + " name='" + name + "' value='" + value + "'/>";
  }
  static Text floating(const Text& name, double x) { return element("float", name, number(x)); }
  static Text string(const Text& name, const Text& value) { return element("string", name, value); }
  static Text triple(double x, double y, double z) { return number(x) + "," + number(y) + "," + number(z); }
  static Text object(const Text& tag, const Text& type, const Text& name, const Text& body) {
    return "<" + tag + " type='" + type + "'" + (name.empty() ? "" : " name='" + name + "'") + ">" + body +
           "</" + tag + ">";
  }
  Text flag(const Text& name, double chance = 0.5) {
    return element("boolean", name, m_draws.chance(chance) ? "true" : "false");
  }
  // What may stay as it is by default.
  Text maybe(const Text& text) { return m_draws.chance(0.5) ? text : ""; }
  // In [0, 1], often at an end.
  double share() { return m_draws.pick({0.0, 1.0, m_draws.unit(), m_draws.unit()}); }
  // Of either sign, and often of no great precision.
  double offset() { return m_draws.chance(0.3) ? m_draws.pick({-1.0, 0.0, 1.0}) : m_draws.between(-2, 2); }
  double angle() { return m_draws.pick({0.0, 90.0, -90.0, 180.0, m_draws.between(0, 360)}); }

  Text color(const Text& name, double most = 1) {
    return element("rgb", name, triple(most * share(), most * share(), most * share()));
  }
  Text uvTransform() {
    const Text scale = number(m_draws.pick({0.0, 1.0, -3.0, 7.3, 1e7})),
               offset = number(m_draws.between(-9, 9));
    return "<transform name='to_uv'><scale x='" + scale + "' y='" + scale + "'/><translate x='" + offset +
           "'/></transform>";
  }
  Text texture(const Text& name, int depth = 0) {
    switch (m_draws.below(depth < 2 ? 5 : 3)) {
      case 0:
        return object("texture", "mesh_attribute", name,
                      string("name", m_draws.pick<Text>({"vertex_color", "face_share", "vertex_absent"})));
      case 1:
      case 2:
        return object(
            "texture", "bitmap", name,
            string("filename", m_files.path(m_draws.pick<Text>({"map.hdr", "bad.exr", "one.exr"}))) +
                string("wrap_mode", m_draws.pick<Text>({"repeat", "clamp", "mirror", "zero", "one"})) +
                string("filter_type", m_draws.pick<Text>({"bilinear", "nearest"})) + flag("raw") +
                maybe(uvTransform()));
      case 3:
        return object("texture", "checkerboard", name,
                      (m_draws.chance(0.5) ? texture("color0", depth + 1) : color("color0")) +
                          color("color1") + maybe(uvTransform()));
      default:
        return object("texture", "scale", name,
                      texture("", depth + 1) + floating("scale", m_draws.pick({0.0, -1.0, 0.5, 100.0})));
    }
  }
  // One that shines, and nothing in it is infinite.
  Text lightTexture(const Text& name) {
    if (m_draws.chance(0.5))
      return object("texture", "checkerboard", name,
                    color("color0", 5) + element("rgb", "color1", "1") + maybe(uvTransform()));
    return object("texture", "bitmap", name,
                  string("filename", m_files.path("map.hdr")) + maybe(uvTransform()));
  }
  // A parameter that may be a number or a texture.
  Text scalar(const Text& name, double x) { return m_draws.chance(0.8) ? floating(name, x) : texture(name); }
  Text colors(const Text& name) { return maybe(m_draws.chance(0.7) ? color(name) : texture(name)); }
  double alpha() { return m_draws.pick({1e-4, 0.02, 0.1, 0.25, 0.5, 1.0}); }
  Text facets(bool textured = true) {
    return maybe(string("distribution", m_draws.pick<Text>({"beckmann", "ggx"}))) +
           maybe(flag("sample_visible")) +
           maybe(!textured             ? floating("alpha", alpha())
                 : m_draws.chance(0.7) ? scalar("alpha", alpha())
                                       : scalar("alpha_u", alpha()) + scalar("alpha_v", alpha()));
  }
  Text iors() { return maybe(floating("int_ior", m_draws.pick({1.01, 1.5, 3.0, 0.7}))); }

  Text bsdf(int depth = 0) {
    static const Text kNesting[] = {"twosided",  "mask",    "blendbsdf",   "bumpmap",
                                    "normalmap", "coating", "roughcoating"};
    const bool nests = depth < 3 && m_draws.chance(0.4);
    return nests ? nesting(kNesting[m_draws.below(std::size(kNesting))], depth + 1) : plainBsdf();
  }
  Text nesting(const Text& type, int depth) {
    const Text perturbation = maybe(flag("flip_invalid_normals")) + maybe(flag("use_shadowing_function"));
    Text body = bsdf(depth);
    if (type == "twosided") body += maybe(bsdf(depth));
    if (type == "mask") body += scalar("opacity", share());
    if (type == "blendbsdf") body += bsdf(depth) + scalar("weight", share());
    if (type == "bumpmap")
      body += texture("") + floating("scale", m_draws.pick({0.0, 0.1, -10.0, 1e5})) + perturbation;
    if (type == "normalmap") body += texture("normalmap") + perturbation;
    if (type == "coating" || type == "roughcoating")
      body += iors() + maybe(color("sigma_a", 3)) + colors("specular_reflectance");
    if (type == "roughcoating") body += facets(false);
    return object("bsdf", type, "", body);
  }
  Text plainBsdf() {
    static const Text kTypes[] = {"diffuse",
                                  "roughdiffuse",
                                  "conductor",
                                  "roughconductor",
                                  "dielectric",
                                  "thindielectric",
                                  "roughdielectric",
                                  "plastic",
                                  "roughplastic",
                                  "pplastic",
                                  "phong",
                                  "ward",
                                  "principled",
                                  "principledthin",
                                  "hair",
                                  "measured",
                                  "measured_polarized",
                                  "null",
                                  "polarizer",
                                  "circular",
                                  "retarder",
                                  "roughplastic",
                                  "roughconductor"};
    const Text type = kTypes[m_draws.below(std::size(kTypes))];
    return object("bsdf", type, "", parametersOf(type));
  }
  Text parametersOf(const Text& type) {
    const auto is = [&](std::initializer_list<const char*> names) {
      return std::find(names.begin(), names.end(), type) != names.end();
    };
    Text body;
    if (is({"diffuse", "roughdiffuse"})) body += colors("reflectance");
    if (is({"plastic", "roughplastic", "pplastic", "phong", "ward"})) body += colors("diffuse_reflectance");
    if (is({"conductor", "roughconductor", "dielectric", "thindielectric", "roughdielectric", "plastic",
            "roughplastic", "pplastic", "phong", "ward"}))
      body += colors("specular_reflectance");
    if (is({"dielectric", "thindielectric", "roughdielectric"})) body += colors("specular_transmittance");
    if (is({"dielectric", "roughdielectric", "plastic", "roughplastic", "hair"})) body += iors();
    if (is({"roughconductor", "roughdielectric", "pplastic"})) body += facets();
    if (type == "roughplastic") body += facets(false);
    if (is({"plastic", "roughplastic"})) body += maybe(flag("nonlinear"));
    if (is({"conductor", "roughconductor"}))
      body += maybe(string("material", m_draws.pick<Text>({"Au", "none"})));
    if (is({"roughdiffuse", "ward"})) body += maybe(scalar("alpha", alpha()));
    if (type == "roughdiffuse") body += maybe(flag("use_fast_approx"));
    if (type == "ward")
      body += maybe(string("variant", m_draws.pick<Text>({"ward", "ward-duer", "balanced"})));
    if (type == "phong") body += maybe(scalar("exponent", m_draws.pick({0.0, 1.0, 300.0, 1e7})));
    if (type == "hair")
      body += floating("longitudinal_roughness", share()) + floating("azimuthal_roughness", share()) +
              maybe(floating("scale_tilt", m_draws.between(-90, 90))) + maybe(color("sigma_a", 5));
    if (type == "measured") body += string("filename", m_files.data("cloth.bsdf"));
    if (type == "measured_polarized")
      body += string("filename", m_files.data("lacquer.pbsdf")) + floating("wavelength", 560);
    if (is({"principled", "principledthin"})) {
      body += colors("base_color");
      for (const char* name :
           {"roughness", "anisotropic", "spec_trans", "spec_tint", "sheen", "sheen_tint", "flatness"})
        body += maybe(scalar(name, share()));
    }
    if (type == "principled")
      for (const char* name : {"metallic", "clearcoat", "clearcoat_gloss", "specular"})
        body += maybe(scalar(name, share()));
    if (type == "principledthin") body += maybe(scalar("diff_trans", 2 * share()));
    return body;
  }

  Text grid(const Text& name, const Text& file) {
    return object("volume", "gridvolume", name,
                  string("filename", m_files.path(file)) + flag("use_grid_bbox") +
                      string("wrap_mode", m_draws.pick<Text>({"clamp", "repeat", "mirror"})) +
                      string("filter_type", m_draws.pick<Text>({"trilinear", "nearest"})) +
                      maybe("<transform name='to_world'>" + placement(false) + "</transform>"));
  }
  Text phase(int depth = 0) {
    static const Text kTypes[] = {"isotropic", "hg", "rayleigh", "tabphase", "sggx", "blendphase"};
    const Text& type = kTypes[m_draws.below(depth < 2 ? 6 : 5)];
    Text body;
    if (type == "hg") body = floating("g", m_draws.pick({-0.999, -0.5, 0.0, 0.7, 0.999}));
    if (type == "tabphase") body = string("values", m_draws.pick<Text>({"1, 0", "0.1, 0, 2, 3"}));
    if (type == "sggx") body = grid("S", "flakes.vol");
    if (type == "blendphase")
      body = phase(depth + 1) + phase(depth + 1) +
             (m_draws.chance(0.5) ? floating("weight", share()) : grid("weight", "density.vol"));
    return object("phase", type, "", body);
  }
  Text medium(const Text& name) {
    const double thickness = m_draws.pick({0.0, 1e-3, 0.3, 3.0, 50.0}) / m_scale;
    Text body = maybe(flag("sample_emitters")) + maybe(phase());
    if (m_draws.chance(0.5))
      return object("medium", "homogeneous", name,
                    body + (m_draws.chance(0.7) ? color("sigma_t", thickness) +
                                                      (m_draws.chance(0.7) ? color("albedo", 0.99)
                                                                           : grid("albedo", "albedo.vol"))
                                                : color("sigma_s", thickness) + color("sigma_a", thickness)));
    const Text density = m_draws.pick<Text>({"density.vol", "albedo.vol"});
    return object("medium", "heterogeneous", name,
                  body + floating("scale", thickness) +
                      (m_draws.chance(0.8) ? grid("sigma_t", density) : color("sigma_t")) +
                      (m_draws.chance(0.5) ? grid("albedo", "albedo.vol") : color("albedo", 0.99)));
  }
  Text plainBoundary() {
    const Text type = m_draws.pick<Text>({"null", "null", "dielectric", "roughdielectric", "thindielectric"});
    return m_draws.chance(0.8) ? object("bsdf", type, "", "") : bsdf();
  }
  // What makes a shape the boundary of media.
  Text media() {
    const Text inside = m_draws.chance(0.8) ? medium("interior") : "";
    return inside + (inside.empty() || m_draws.chance(0.2) ? medium("exterior") : "");
  }

  // From the unit of a shape or a lamp to the world.
  Text placement(bool mirrored) {
    const double size = m_draws.pick({1.0, 1.0, 1.0, 1.0, 0.3, 0.01, 20.0, 1e3}) * m_scale;
    const bool uneven = m_draws.chance(0.2);
    Text scale = "<scale x='" + number(mirrored ? -size : size) + "' y='" + number(size) + "' z='" +
                 number(uneven ? size * m_draws.pick({0.1, 1e-3, 10.0}) : size) + "'/>";
    const Text axis = m_draws.pick<Text>({"x", "y", "z"});
    return scale + "<rotate " + axis + "='1' angle='" + number(angle()) + "'/><translate x='" +
           number(m_origin[0] + m_scale * offset()) + "' y='" + number(m_origin[1] + m_scale * offset()) +
           "' z='" + number(m_origin[2] + m_scale * offset()) + "'/>";
  }
  Text toWorld() {
    const bool mirrored = m_draws.chance(0.1);
    if (m_draws.chance(0.85)) return "<transform name='to_world'>" + placement(mirrored) + "</transform>";
    return "<animation name='to_world'><transform time='0'>" + placement(mirrored) +
           "</transform><transform time='1'>" + placement(mirrored) + "</transform></animation>";
  }
  Text emission() {
    return object(
        "emitter", "area", "",
        m_draws.chance(0.7) ? color("radiance", m_draws.pick({1.0, 1e3, 1e-3})) : lightTexture("radiance"));
  }
  Text plainShape(Text body, bool mayShine, bool mayMeasure = false, bool mayBound = true) {
    static const Text kTypes[] = {"sphere", "rectangle",  "cube",        "disk",         "cylinder", "obj",
                                  "ply",    "serialized", "linearcurve", "bsplinecurve", "sdfgrid"};
    // Neither lamps nor meters lie on the last three.
    const uint32_t kind = m_draws.below(mayMeasure ? 8 : std::size(kTypes));
    const Text& type = kTypes[kind];
    const bool bounds = mayBound && m_draws.chance(0.15) && body.find("<animation") == Text::npos;
    body += bounds ? media() + plainBoundary() : bsdf();
    if (kind < 8) body += maybe(flag("flip_normals"));
    if (kind < 8 && mayShine && m_draws.chance(0.3)) body += emission();
    if (kind >= 5) body += string("filename", m_files.shape(type));
    if (kind >= 5 && kind < 8) body += maybe(flag("face_normals"));
    return object("shape", type, "", body);
  }
  Text shape(const Text& nested) {
    if (!nested.empty() || m_draws.chance(0.85)) return plainShape(nested + toWorld(), true, !nested.empty());
    const Text id = "group" + std::to_string(m_groups++), place = toWorld();
    const bool isStill = place.find("<animation") == Text::npos;
    const Text group =
        "<shape type='shapegroup' id='" + id + "'>" +
        plainShape("<transform name='to_world'><scale value='0.5'/></transform>", false, false, isStill) +
        "</shape>";
    return group + object("shape", "instance", "", "<ref id='" + id + "'/>" + place);
  }

  Text light() {
    const Text strength = m_draws.chance(0.8) ? "" : floating("scale", m_draws.pick({0.0, 1e-6, 1e6}));
    switch (m_draws.below(9)) {
      case 0:
        return object("emitter", "point", "",
                      element("point", "position", place()) + color("intensity", 10 * m_scale * m_scale));
      case 1:
        return object("emitter", "spot", "",
                      toWorld() + floating("cutoff_angle", m_draws.pick({0.1, 20.0, 89.0})) +
                          maybe(lightTexture("texture")) + color("intensity", 10 * m_scale * m_scale));
      case 2:
        return object(
            "emitter", "directional", "",
            element("vector", "direction", triple(m_draws.between(-1, 1), m_draws.between(-1, 1), -1)));
      case 3:
        return object(
            "emitter", "projector", "",
            toWorld() + lightTexture("irradiance") + floating("fov", m_draws.pick({1.0, 45.0, 170.0})));
      case 4:
        return object("emitter", m_draws.pick<Text>({"sky", "sun", "sunsky"}), "",
                      element("integer", "resolution", "8") + floating("turbidity", m_draws.between(1, 10)) +
                          maybe(floating("hour", m_draws.between(10, 14))) + strength);
      default:
        return object(
            "emitter", "envmap", "",
            string("filename", m_files.path(m_draws.pick<Text>({"map.hdr", "bad.exr", "one.exr"}))) +
                maybe(toWorld()) + strength);
    }
  }

  Text place() {
    return triple(m_origin[0] + m_scale * offset(), m_origin[1] + m_scale * offset(),
                  m_origin[2] + m_scale * offset());
  }
  Text film() {
    static const char* const kFilters[] = {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"};
    const int width = 4 + int(m_draws.below(12)), height = 4 + int(m_draws.below(12));
    const Text side = m_draws.pick<Text>({"1", "2"});
    const Text crop = element("integer", "crop_offset_x", "1") + element("integer", "crop_offset_y", "1") +
                      element("integer", "crop_width", side) + element("integer", "crop_height", side);
    return object("film", "hdrfilm", "",
                  element("integer", "width", std::to_string(width)) +
                      element("integer", "height", std::to_string(height)) +
                      (m_draws.chance(0.15) ? crop : "") +
                      object("rfilter", kFilters[m_draws.below(std::size(kFilters))], "", ""));
  }
  Text irradianceMeter() { return object("sensor", "irradiancemeter", "", film()); }
  Text sensor() {
    const Text type =
        m_draws.pick<Text>({"perspective", "perspective", "thinlens", "orthographic", "radiancemeter"});
    const Text scale = type == "orthographic" ? "<scale value='" + number(2 * m_scale) + "'/>" : "";
    Text body = "<transform name='to_world'>" + scale + "<lookat origin='" + place() + "' target='" +
                place() + "' up='0.1,1,0.2'/></transform>" + film();
    if (type != "radiancemeter")
      body += floating("near_clip", 1e-3 * m_scale) + floating("far_clip", 1e5 * m_scale) +
              floating("shutter_open", 0) + floating("shutter_close", m_draws.pick({0.0, 1.0}));
    if (type == "perspective" || type == "thinlens")
      body += floating("fov", m_draws.pick({1.0, 40.0, 90.0, 160.0}));
    if (type == "thinlens")
      body += floating("aperture_radius", 0.1 * m_scale) + floating("focus_distance", 2 * m_scale);
    if (m_draws.chance(0.05)) body += medium("");
    return object("sensor", type, "", body);
  }
  Text integrator() {
    return object("integrator", m_draws.chance(0.1) ? "volpath" : "path", "",
                  element("integer", "max_depth", m_draws.pick<Text>({"-1", "2", "8", "12"})) +
                      element("integer", "rr_depth", m_draws.pick<Text>({"1", "5"})) +
                      flag("hide_emitters", 0.2));
  }

  Draws& m_draws;
  const SceneFiles& m_files;
  double m_scale, m_origin[3];
  int m_groups = 0;
};

}  // namespace odis::test
