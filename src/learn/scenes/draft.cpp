#include "learn/scenes/draft.h"

namespace odis::learn {

void Draft::add(const Piece& piece, const Vec3& position, float angle) {
  const Matrix4 placement = placed(position, angle);
  for (const Part& part : piece.parts) {
    MeshData mesh;
    append(mesh, part.mesh, placement);
    add(std::move(mesh), part.material, part.radiance);
  }
  for (Ball ball : piece.balls) {
    ball.center = render::transformPoint(placement, ball.center);
    scene.balls.push_back(ball);
  }
}

}  // namespace odis::learn
