// The pilot's vertices as a file that other programs read.
#pragma once

#include <odis/path_vertex.h>

#include <string>
#include <vector>

namespace odis::app {

// Writes a NumPy structured array (.npy, version 1.0), one element a vertex with the fields of PathVertex by
// name; `numpy.load` opens it. Under a temporary name first, then renamed. Throws std::runtime_error with
// path and reason.
void writeRecords(const std::string& path, const std::vector<PathVertex>& vertices);

}  // namespace odis::app
