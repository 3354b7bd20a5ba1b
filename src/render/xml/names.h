// Names in scene files: their spelling and what a misspelt one may have meant.
#pragma once

#include <string>
#include <vector>

namespace odis::render {

// "toWorld" and "to_world" -> "to_world", "intIOR" -> "int_ior", "kNN" -> "k_nn", "color0" -> "color0".
std::string snakeCase(const std::string& name);
std::string lowerCase(std::string text);
// How many letters to insert, delete or replace, or pairs of neighbours to swap, make one the other.
size_t editDistance(const std::string& a, const std::string& b);
// " (did you mean 'a' or 'b'?)" with the known names that are near, the nearest first; "" if none is.
std::string suggestion(const std::string& name, const std::vector<std::string>& known);

}  // namespace odis::render
