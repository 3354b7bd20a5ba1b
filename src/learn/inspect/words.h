// Sentences that the picture and the text of an inspection share.
#pragma once

#include <string>
#include <vector>

#include "learn/inspect/inspect.h"

namespace odis::learn {

const char* className(int roughnessClass);
std::string placeWords(const Inspection& inspection);
std::string cellWords(const Inspection& inspection);
// What the guide decides there, a line each.
std::vector<std::string> decisionWords(const Inspection& inspection);
// What is to be said of one of its maps.
std::vector<std::string> mapWords(const Inspection& inspection, const MapView& map);

}  // namespace odis::learn
