// Renderings that may be killed: --save-every and --resume.
#pragma once

#include "render/scene/scene.h"
#include "render_arguments.h"

namespace odis::app {

// Throws UsageError where a rendering can't be saved, or can't go on.
void checkSaving(const RenderArguments& a);
// The file that it is saved to. Throws UsageError where the output is a pipe or the like.
std::string savedFile(const RenderArguments& a);
// How `options`, which are complete otherwise, are to be saved: nothing that decides about the image may
// differ when the rendering goes on, the contents of the scene's files included.
render::SavingOptions savingOf(const RenderArguments& a, const render::RenderOptions& options,
                               const render::Scene& scene);
// Says how an interrupted rendering goes on.
void tellOfSaved(const RenderArguments& a);
// Removes the file once the image is complete.
void removeSaved(const RenderArguments& a);

}  // namespace odis::app
