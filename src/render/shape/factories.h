// The factories of shapes, one a model and defined in its file, and what they have in common.
#pragma once

#include "render/scene/builder.h"
#include "render/shape/mesh.h"

namespace odis::render {

ShapePtr makeBsplineCurve(const Properties& node, Builder& builder);
ShapePtr makeCube(const Properties& node, Builder& builder);
ShapePtr makeCylinder(const Properties& node, Builder& builder);
ShapePtr makeDisk(const Properties& node, Builder& builder);
ShapePtr makeLinearCurve(const Properties& node, Builder& builder);
ShapePtr makeObj(const Properties& node, Builder& builder);
ShapePtr makePly(const Properties& node, Builder& builder);
ShapePtr makeRectangle(const Properties& node, Builder& builder);
ShapePtr makeSdfGrid(const Properties& node, Builder& builder);
ShapePtr makeSerialized(const Properties& node, Builder& builder);
ShapePtr makeSphere(const Properties& node, Builder& builder);

// Light finds spheres that are all but points; the squares of larger ones leave single precision.
inline constexpr NumberRange kRadiusRange = between(1e-30, 1e15);

// The parameter to_world; throws SceneError if it can't be inverted.
Imath::M44d readToWorld(const Properties& node);

// A mesh from a file, with the parameters that all such shapes share. `flipTexCoords`: unless the scene says
// otherwise.
ShapePtr makeMeshOfFile(const Properties& node, Builder& builder, bool flipTexCoords);

}  // namespace odis::render
