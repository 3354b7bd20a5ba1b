// Files of other programs that are given in place of a scene, so that errors can say what they are.
#pragma once

#include <pugixml.hpp>

#include <string>
#include <string_view>

namespace odis::render {

// What a file is, and what makes a scene of it, by how it begins; "" if it may be XML.
std::string foreignFile(std::string_view text);

// The same of XML, by its outermost element and what that holds; "" if it may be a scene of Mitsuba.
std::string foreignElement(const pugi::xml_node& root);

}  // namespace odis::render
