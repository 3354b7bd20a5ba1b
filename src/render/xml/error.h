// Errors and warnings that speak to the user: file:line:column, what was expected, what to do.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace odis::render {

// Where in an input file; line and column count from 1, 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  std::string text() const {
    std::string result = file;
    for (const int number : {line, column}) {
      if (number <= 0) break;
      result += ':';
      result += std::to_string(number);
    }
    return result;
  }
};

// Texts hold what files hold: control characters would break the line or command the terminal, and a name may
// be megabytes long.
std::string onOneLine(std::string text);

// Input that cannot be drawn. what() is "file:line:column: message".
class SceneError : public std::runtime_error {
 public:
  SceneError(const SourceLocation& at, const std::string& message)
      : std::runtime_error(onOneLine(at.file.empty() ? message : at.text() + ": " + message)),
        m_at(at),
        m_message(message) {}
  const SourceLocation& at() const { return m_at; }
  const std::string& message() const { return m_message; }

 private:
  SourceLocation m_at;
  std::string m_message;
};

// Files that a scene names and that are not there. what() tells of the first and counts the others.
class MissingFiles : public SceneError {
 public:
  // At least one.
  explicit MissingFiles(std::vector<SceneError> files);
  const std::vector<SceneError>& files() const { return m_files; }

 private:
  std::vector<SceneError> m_files;
};

// A size or crop that the caller asks for and no image of the scene can have.
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What becomes of the picture where a scene isn't read as it is written.
enum class Effect {
  none,        // nothing: a hint to another program or to the method
  same,        // it is made in another way
  difference,  // it is another picture than the scene describes
};

// Input that can still be drawn. Each text is kept once.
class Warnings {
 public:
  // Warnings that differ in their place and in numbers alone.
  struct Group {
    std::string first;
    std::vector<SourceLocation> others;  // where the rest stands

    // The first, and how many more there are.
    std::string text() const;
  };

  void add(const SourceLocation& at, const std::string& message, Effect effect = Effect::difference);
  void add(const Warnings& others);
  // What is said of this file counts as said where the scene names it first.
  void addFile(const std::string& file, const SourceLocation& namedAt);

  // In the order of the scene; what is said of a file as a whole comes after what is said of its lines.
  std::vector<std::string> texts(Effect effect = Effect::difference) const;
  std::vector<Group> groups(Effect effect = Effect::difference) const;
  // Whether one place comes before another in that order.
  bool isBefore(const SourceLocation& a, const SourceLocation& b) const { return placeOf(a) < placeOf(b); }
  size_t count(Effect effect = Effect::difference) const { return m_warnings[size_t(effect)].size(); }

 private:
  struct Warning {
    SourceLocation at;
    std::string message;

    std::string text() const;
  };
  std::vector<const Warning*> inOrder(Effect effect) const;
  // Line and column in the scene, then in the file that is named there, and so on.
  std::vector<std::pair<int, int>> placeOf(SourceLocation at) const;

  std::array<std::vector<Warning>, 3> m_warnings;  // by effect
  std::unordered_set<std::string> m_known;
  std::unordered_map<std::string, SourceLocation> m_namedAt;  // by file; no place for the scene itself
};

}  // namespace odis::render
