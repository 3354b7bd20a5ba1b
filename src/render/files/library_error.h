// Libraries that ODIS can do without: what is said where one of them is asked for and missing.
#pragma once

#include <stdexcept>
#include <string>

namespace odis::render {

// "libtorch is missing, which `odis train` needs: `scripts/setup --train` installs it": `user` is what needs
// the part, `remedy` how to get it.
inline std::string missingText(const std::string& part, const std::string& user, const std::string& remedy) {
  return part + " is missing, which " + user + " needs: " + remedy;
}

// A library that is missing (what() begins with missingText), or that failed.
class LibraryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace odis::render
