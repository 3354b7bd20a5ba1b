// Mesh attribute: what the file of a mesh says of its vertices, in between interpolated, or of its faces.
//
//   name    string   required; vertex_NAME or face_NAME of what obj.cpp, ply.cpp and serialized.cpp read
//   scale   number   multiplies the values; default 1
//
// On shapes that have no such attribute it is black.
#include "render/texture/mesh_attribute.h"

#include "render/scene/builder.h"
#include "render/shape/shape.h"

namespace odis::render {

Rgb MeshAttributeTexture::rgbAt(const SurfacePoint& at) const {
  const std::optional<Rgb> value = at.shape ? at.shape->attribute(m_name, at) : std::nullopt;
  return value ? *value * m_scale : Rgb(0);
}

TexturePtr makeMeshAttributeTexture(const Properties& node, Builder&) {
  const std::string name = node.string("name");
  if (!name.starts_with("vertex_") && !name.starts_with("face_"))
    node.refuse("name", "'" + name + "'", "a name that begins with vertex_ or face_");
  return std::make_shared<MeshAttributeTexture>(name, node.number("scale", between(0, 1e10), 1.0f));
}

}  // namespace odis::render
