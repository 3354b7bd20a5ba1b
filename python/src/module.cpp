#include <odis/odis.hpp>

#include "bindings.h"

NB_MODULE(_odis, module) {
  using namespace odis::python;  // NOLINT: all that this function does is call them
  module.doc() = "The compiled part of the package odis.";
  module.attr("version_text") = odisGetVersionText();
  module.attr("NO_CELL") = ODIS_NO_CELL;
  module.attr("LEAST_CACHED_MAX_DEPTH") = ODIS_LEAST_CACHED_MAX_DEPTH;
  module.attr("NO_LIGHT_GROUP") = ODIS_NO_LIGHT_GROUP;
  bindErrors(module);
  bindContext(module);
  bindModel(module);
  bindOptions(module);
  bindVertices(module);
  bindGuide(module);
  bindGuideBuilder(module);
  bindFrame(module);
}
