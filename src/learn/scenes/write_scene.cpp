#include "learn/scenes/write_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "learn/scenes/write_ply.h"
#include "render/files/checked_stream.h"
#include "render/files/replace_file.h"

namespace odis::learn {

void writeFile(const std::string& path, const std::string& bytes) {
  try {
    render::CheckedStream stream(path);
    stream.write(bytes.data(), bytes.size());
    stream.close();
  } catch (const std::runtime_error& error) {
    throw render::WriteError(fmt::format("cannot write \"{}\": {}", path, error.what()));
  }
}

namespace {

// Numbers are written as the shortest text that gives the same float again.
std::string numbers(const Vec3& v) {
  return fmt::format("{}, {}, {}", v.x, v.y, v.z);
}
std::string numbers(const Rgb& c) {
  return fmt::format("{}, {}, {}", c.x, c.y, c.z);
}

class Writer {
 public:
  Writer(const Description& scene, std::string folder, bool again)
      : m_scene(scene),
        m_folder(std::move(folder)),
        m_placement(placed(Vec3(0), scene.turn)),
        m_again(again) {
    m_xml = fmt::format(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- {} -->\n<scene version=\"3.0.0\">\n", scene.kind);
  }

  void write() {
    std::filesystem::create_directories(m_folder + "/meshes");
    if (!m_scene.files.empty()) std::filesystem::create_directories(m_folder + "/textures");
    for (const Description::File& file : m_scene.files) write(file.name, file.bytes);
    for (const std::string& material : m_scene.materials) m_xml += "  " + material + "\n";
    // Surfaces of one material are one mesh, every light is one of its own.
    std::map<MaterialId, MeshData> surfaces;
    for (const Part& part : m_scene.parts)
      if (render::isBlack(part.radiance)) append(surfaces[part.material], part.mesh, m_placement);
    for (auto& [material, mesh] : surfaces) writeMesh(mesh, material, Rgb(0.0f));
    for (const Part& part : m_scene.parts) {
      if (render::isBlack(part.radiance)) continue;
      MeshData mesh;
      append(mesh, part.mesh, m_placement);
      writeMesh(mesh, part.material, part.radiance);
    }
    for (const Ball& ball : m_scene.balls) writeBall(ball);
    for (const PointLight& light : m_scene.pointLights) writePointLight(light);
    writeEnvironment();
    m_xml += "</scene>\n";
    writeFile(m_folder + "/content.xml", m_xml);
  }

 private:
  void write(const std::string& name, const std::string& bytes) const {
    if (!m_again) writeFile(m_folder + "/" + name, bytes);
  }
  // The file's world is turned, then scaled; meshes arrive turned.
  Vec3 world(const Vec3& p) const { return render::transformPoint(m_placement, p) * m_scene.scale; }
  Vec3 direction(const Vec3& d) const { return render::transformVector(m_placement, d); }

  void writeMesh(MeshData& mesh, MaterialId material, const Rgb& radiance) {
    if (mesh.triangles.empty()) return;
    for (Vec3& p : mesh.positions) p *= m_scene.scale;
    const std::string name = fmt::format("meshes/{:03}.ply", m_meshes++);
    write(name, encodePly(mesh));
    m_xml += fmt::format("  <shape type=\"ply\">\n    <string name=\"filename\" value=\"{}\"/>\n", name);
    // Renderers differ in what an interpolated normal does to emitted light: docs/agreement.md.
    if (!render::isBlack(radiance)) m_xml += "    <boolean name=\"face_normals\" value=\"true\"/>\n";
    finishShape(material, radiance);
  }
  void writeBall(const Ball& ball) {
    m_xml += fmt::format(
        "  <shape type=\"sphere\">\n    <point name=\"center\" value=\"{}\"/>\n"
        "    <float name=\"radius\" value=\"{}\"/>\n",
        numbers(world(ball.center)), ball.radius * m_scene.scale);
    finishShape(ball.material, ball.radiance);
  }
  void finishShape(MaterialId material, const Rgb& radiance) {
    if (material == kNoMaterial)
      m_xml += "    <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf>\n";
    else
      m_xml += fmt::format("    <ref id=\"material-{}\"/>\n", material);
    if (!render::isBlack(radiance))
      m_xml += fmt::format("    <emitter type=\"area\"><rgb name=\"radiance\" value=\"{}\"/></emitter>\n",
                           numbers(radiance * m_scene.exposure));
    m_xml += "  </shape>\n";
  }
  void writePointLight(const PointLight& light) {
    // An intensity lights as well as before if it grows with the square of the lengths.
    const Rgb intensity = light.intensity * (m_scene.exposure * m_scene.scale * m_scene.scale);
    const Vec3 at = world(light.position);
    if (light.cutoff > 0) {
      const Vec3 to = at + direction(light.direction) * m_scene.scale;
      const Vec3 up = std::abs(light.direction.z) > 0.9f ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
      m_xml += fmt::format(
          "  <emitter type=\"spot\">\n    <transform name=\"to_world\"><lookat origin=\"{}\" target=\"{}\" "
          "up=\"{}\"/></transform>\n    <float name=\"cutoff_angle\" value=\"{}\"/>\n",
          numbers(at), numbers(to), numbers(up), light.cutoff);
    } else {
      m_xml += fmt::format("  <emitter type=\"point\">\n    <point name=\"position\" value=\"{}\"/>\n",
                           numbers(at));
    }
    m_xml += fmt::format("    <rgb name=\"intensity\" value=\"{}\"/>\n  </emitter>\n", numbers(intensity));
  }
  void writeEnvironment() {
    const Environment& e = m_scene.environment;
    const float scale = e.scale * m_scene.exposure;
    if (e.kind == Environment::Kind::constant)
      m_xml += fmt::format("  <emitter type=\"constant\"><rgb name=\"radiance\" value=\"{}\"/></emitter>\n",
                           numbers(e.radiance * scale));
    if (e.kind == Environment::Kind::daylight)
      m_xml += fmt::format(
          "  <emitter type=\"sunsky\">\n    <vector name=\"sun_direction\" value=\"{}\"/>\n"
          "    <float name=\"turbidity\" value=\"{}\"/>\n{}"
          "    <float name=\"sky_scale\" value=\"{}\"/>\n    <float name=\"sun_scale\" value=\"{}\"/>\n"
          "  </emitter>\n",
          numbers(direction(e.sunDirection)), e.turbidity,
          // Either says that up is +z.
          e.sunScale > 0 ? fmt::format("    <float name=\"sun_aperture\" value=\"{}\"/>\n", e.sunAperture)
                         : "    <boolean name=\"complex_sun\" value=\"false\"/>\n",
          scale, scale * e.sunScale);
    if (e.kind == Environment::Kind::map)
      m_xml += fmt::format(
          "  <emitter type=\"envmap\">\n    <string name=\"filename\" value=\"{}\"/>\n"
          "    <float name=\"scale\" value=\"{}\"/>\n"
          "    <transform name=\"to_world\"><rotate x=\"1\" angle=\"90\"/><rotate z=\"1\" "
          "angle=\"{}\"/></transform>\n  </emitter>\n",
          e.file, scale, (e.turn + m_scene.turn) * (180 / render::kPi));
  }

  const Description& m_scene;
  std::string m_folder, m_xml;
  Matrix4 m_placement;
  bool m_again;
  int m_meshes = 0;
};

}  // namespace

View inWorld(const Description& scene, const View& view) {
  const Matrix4 placement = placed(Vec3(0), scene.turn);
  View result = view;
  result.origin = render::transformPoint(placement, view.origin) * scene.scale;
  result.target = render::transformPoint(placement, view.target) * scene.scale;
  return result;
}

void writeContent(const Description& scene, const std::string& folder, bool again) {
  Writer(scene, folder, again).write();
}

void writeViews(const Description& scene, const std::string& folder) {
  for (size_t i = 0; i < scene.views.size(); ++i) {
    const View view = inWorld(scene, scene.views[i]);
    const std::string name = i == 0 ? "scene.xml" : fmt::format("scene-{}.xml", char('a' + i));
    writeFile(folder + "/" + name,
              fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">
  <default name="spp" value="16"/>
  <default name="resx" value="{}"/>
  <default name="resy" value="{}"/>
  <integrator type="path"/>
  <sensor type="perspective">
    <float name="fov" value="{}"/>
    <string name="fov_axis" value="larger"/>
    <float name="near_clip" value="{}"/>
    <float name="far_clip" value="{}"/>
    <transform name="to_world">
      <lookat origin="{}" target="{}" up="0, 0, 1"/>
    </transform>
    <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
    <film type="hdrfilm">
      <integer name="width" value="$resx"/>
      <integer name="height" value="$resy"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <include filename="content.xml"/>
</scene>
)",
                          view.resolution.x, view.resolution.y, view.fov, 1e-3f * scene.scale,
                          1e4f * scene.scale, numbers(view.origin), numbers(view.target)));
  }
}

}  // namespace odis::learn
