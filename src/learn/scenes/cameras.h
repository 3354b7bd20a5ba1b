// Cameras that see something, and how bright a scene is in front of them.
#pragma once

#include "learn/scenes/description.h"
#include "learn/scenes/random.h"
#include "render/scene/scene.h"

namespace odis::learn {

// Chooses two views of the scene, which has been loaded from what was written of it. False if there are no
// two places that see enough.
bool chooseViews(Description& scene, render::Scene& loaded, Random random);

// Scales the scene's lights so that its views are about as bright as `target`, by a few hundred test paths
// each. False if a view is black or next to it, or much darker than the other.
bool expose(Description& scene, render::Scene& loaded, float target);

}  // namespace odis::learn
