// Options that change nothing beside others: they are refused where that can be told from the command line,
// and told where it depends on the scene.
#pragma once

#include <string>
#include <vector>

#include "output.h"
#include "render_arguments.h"

namespace odis::app {

// Throws UsageError if one of these settings, "key=value", has no effect on the method of these options.
void requireEffects(const render::RenderOptions& options, const std::vector<std::string>& settings);
// The same of the other options of `odis render`. Takes layers that the integrator lacks from those of
// --aov all.
void requireEffects(const RenderArguments& a, Layers& layers);
// Throws UsageError if --exposure is given and no PNG is written.
void requirePngToExpose(float exposure, const std::string& png, const std::string& output);
// Throws UsageError, or tells, if options have no effect on a scene; `options` hold what it asks for.
void tellWithoutEffect(const RenderArguments& a, const render::RenderOptions& options,
                       const render::FilmSettings& film);

}  // namespace odis::app
