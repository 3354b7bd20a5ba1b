// Reads Mitsuba scene files of every age (0.5, 0.6, 2.x, 3.x) into a tree of Properties.
//
// Done here: <include>, <default> and `$name` or `${name}` anywhere in an attribute, <ref> and <alias>
// (before or after what they refer to), <path>, transforms, spectra, and the change of names to snake_case.
// Errors carry file:line:column of the element; columns count bytes from 1.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/xml/properties.h"

namespace odis::render {

struct ParsedScene {
  std::shared_ptr<const Properties> root;  // its tag is "scene"
  std::vector<std::string> folders;  // where files are looked for: the scene's folder, then those of <path>
  std::vector<std::string> files;    // that were read: the scene's own, included ones, spectra
  // Of those that should have been read: what stands in them is missing from the tree, and references to it
  // lead to empty elements.
  std::vector<SceneError> missing;
};

// `defines` come before the <default>s of the file. Throws SceneError.
ParsedScene parseScene(const std::string& path, const std::map<std::string, std::string>& defines,
                       Warnings& warnings);
// The same from memory; `fileName` stands in error texts and says where relative file names start.
ParsedScene parseSceneText(std::string text, const std::string& fileName,
                           const std::map<std::string, std::string>& defines, Warnings& warnings);

}  // namespace odis::render
