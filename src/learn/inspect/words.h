// Words and sentences that pictures and texts of inspections share.
#pragma once

#include <string>
#include <vector>

#include "learn/inspect/saved.h"

namespace odis::learn {

std::string vectorText(const Float3& v);
const char* className(int roughnessClass);
std::string boundsWords(const Bounds& bounds);
// "diffuse 0.5, rough 1, glossy 0.2".
std::string fractionWords(const float* ofClasses);
std::string placeWords(const Inspection& inspection);
std::string cellWords(const Inspection& inspection);
// What the guide decides there, a line each.
std::vector<std::string> decisionWords(const Inspection& inspection);
// The same of a cell of a saved guide, and where it is.
std::string savedCellWords(const CellSummary& cell);
std::vector<std::string> savedDecisionWords(const CellSummary& cell);
// What is to be said of one of its maps.
std::vector<std::string> mapWords(const Inspection& inspection, const MapView& map);

}  // namespace odis::learn
