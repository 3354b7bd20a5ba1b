// All parameters of all elements: what is out of the declared range or of another kind is refused where it
// stands, what is at an end of the range is taken, and docs/scene-parameters*.md list them all.
#include <cmath>
#include <set>
#include <sstream>

#include "scene/declared_parameters.h"
#include "support/markdown_table.h"
#include "support/random.h"

namespace odis::test {
namespace {

using render::Declaration;

struct Trial {
  std::string element;
  bool right;
};

bool begins(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

std::string valueElement(const std::string& tag, const std::string& name, const std::string& value) {
  return "<" + tag + " name='" + name + "' value='" + value + "'/>";
}

std::string textOf(double value) {
  return fmt::format("{}", value);
}

// Numbers just outside of a range, and its ends or what lies next to them.
std::pair<std::vector<double>, std::vector<double>> aroundRange(const render::NumberRange& range,
                                                                bool whole) {
  std::vector<double> outside, inside;
  const auto step = [&](double end) { return whole ? 1 : std::max(std::abs(end) * 1e-3, 1e-4); };
  const bool below = range.least > std::numeric_limits<double>::lowest(),
             above = range.most < std::numeric_limits<double>::max();
  // A small positive end has the zero below it.
  if (below) outside.push_back(range.least > 0 && !whole ? range.least / 2 : range.least - step(range.least));
  if (above) outside.push_back(range.most + step(range.most));
  (range.withLeast ? inside : outside).push_back(below ? range.least : -1e30);
  (range.withMost ? inside : outside).push_back(above ? range.most : 1e30);
  if (!range.withLeast) inside.push_back(range.least + 1e-3);
  if (!range.withMost) inside.push_back(range.most - 1e-3);
  if (range.also) inside.push_back(*range.also);
  return {outside, inside};
}

std::vector<Trial> trialsOfNumber(const std::string& name, const Declaration& declaration) {
  const std::string type = declaration.type;
  const bool whole = type == "integer", colour = type.find("colour") != std::string::npos;
  const std::string tag = whole ? "integer" : "float";
  const auto [outside, inside] = aroundRange(declaration.range, whole);
  std::vector<Trial> trials;
  const auto add = [&](double value, bool right) {
    trials.push_back({valueElement(tag, name, textOf(value)), right});
    if (colour) trials.push_back({valueElement("rgb", name, "0.5 0.5 " + textOf(value)), right});
  };
  for (const double value : outside) add(value, false);
  for (const double value : inside) add(value, true);
  for (const char* value : {"nan", "inf", "-inf", "1e60", "", "1,5", "half", "0x10"})
    trials.push_back({valueElement(tag, name, value), false});
  for (const std::string& other :
       {valueElement("string", name, "nonsense"), valueElement("boolean", name, "true"),
        valueElement("point", name, "0 0 0")})
    trials.push_back({other, false});
  if (whole) trials.push_back({valueElement("float", name, "1.5"), false});
  return trials;
}

std::vector<Trial> trialsOf(const std::string& name, const Declaration& declaration) {
  const std::string type = declaration.type;
  if (type == "boolean")
    return {{valueElement("boolean", name, "true"), true},
            {valueElement("boolean", name, "maybe"), false},
            {valueElement("integer", name, "1"), false}};
  if (type == "string" && *declaration.words) {
    std::vector<Trial> trials = {{valueElement("string", name, "nonsense"), false},
                                 {valueElement("float", name, "1"), false}};
    std::istringstream stream(declaration.words);
    for (std::string word; std::getline(stream, word, '|');)
      trials.push_back({valueElement("string", name, word), true});
    return trials;
  }
  if (type == "string" || type == "texture" || type == "volume")
    return {{valueElement("boolean", name, "true"), false}};
  if (type == "point or vector")
    return {{valueElement("point", name, "0.5 0.5 0.5"), true},
            {valueElement("vector", name, "nan 0 0"), false},
            {valueElement("point", name, "0 0"), false},
            {valueElement("float", name, "1"), false}};
  if (type == "transform")
    return {{"<transform name='" + name + "'><scale value='2'/></transform>", true},
            {valueElement("float", name, "1"), false}};
  return trialsOfNumber(name, declaration);
}

// Whether it scatters finite light.
void expectSound(const Made& made, const std::string& what) {
  Random random(7);
  render::SurfacePoint at;
  at.dpdu = {1, 0, 0};
  at.dpdv = {0, 1, 0};
  for (int i = 0; i < 64; ++i) {
    const Vec2 u = random.pair();
    if (made.bsdf) {
      const Vec3 wo = normalize(Vec3(u.x - 0.5f, u.y - 0.5f, i % 2 ? 0.3f : -0.3f));
      const render::BsdfSample sample = made.bsdf->sample(at, wo, u.y, random.pair());
      EXPECT_TRUE(render::isFinite(sample.weight) && std::isfinite(sample.pdf)) << what;
    }
    if (made.filter) EXPECT_TRUE(std::isfinite(made.filter->sample(u).weight)) << what;
  }
}

TEST(Parameters, AreRefusedOutsideOfTheirRangesAndTakenAtTheirEnds) {
  const ElementMaker maker;
  int count = 0;
  for (const ElementType& type : allElementTypes())
    for (const auto& [name, declaration] : maker.make(type).declarations)
      for (const Trial& trial : trialsOf(name, declaration)) {
        // The largest table takes seconds.
        if (name == "resolution" && trial.right && trial.element.find("16384") != std::string::npos) continue;
        ++count;
        const Made made = maker.make(type, name, trial.element);
        const std::string what = type.type + ": " + trial.element + ": " + made.error;
        const bool refused =
            begins(made.error, maker.place()) && made.error.find("found ") != std::string::npos;
        if (trial.right || (declaration.clamped && made.error.empty())) {
          EXPECT_FALSE(refused && made.error.find("for '" + name + "'") != std::string::npos) << what;
          if (!trial.right) EXPECT_FALSE(made.warnings.empty()) << what;
          expectSound(made, what);
        } else {
          EXPECT_TRUE(refused && made.error.find("'" + name + "'") != std::string::npos) << what;
        }
      }
  EXPECT_GT(count, 2500);
}

TEST(Parameters, ThatAreRequiredAreMissed) {
  const ElementMaker maker;
  int count = 0;
  for (const ElementType& type : allElementTypes())
    for (const auto& [name, declaration] : maker.make(type).declarations) {
      if (declaration.fallbackText() != "required") continue;
      ++count;
      EXPECT_NE(maker.make(type, name, "").error.find(name), std::string::npos) << type.type << " " << name;
    }
  EXPECT_GT(count, 10);
}

TEST(Parameters, ThatAreMisspeltGetAWarningWithTheNameThatWasMeant) {
  const ElementMaker maker;
  for (const ElementType& type : allElementTypes())
    for (const auto& entry : maker.make(type).declarations) {
      const std::string& name = entry.first;
      if (name.size() < 4) continue;
      const std::string wrong = name.substr(0, name.size() - 1) + "x";
      const Made made = maker.make(type, wrong, valueElement("string", wrong, "1"));
      const bool warned =
          std::any_of(made.warnings.begin(), made.warnings.end(), [&](const std::string& text) {
            return begins(text, maker.place() + "unknown parameter '" + wrong + "'") &&
                   text.find("'" + name + "'") != std::string::npos;
          });
      EXPECT_TRUE(warned || !made.error.empty()) << type.type << " " << wrong;
    }
}

// Rows of the manual: heading, parameter, values, default, type.
using Rows = std::set<std::array<std::string, 5>>;

Rows rowsOfProgram() {
  const ElementMaker maker;
  Rows rows;
  for (const ElementType& type : allElementTypes())
    for (const auto& [name, declaration] : maker.make(type).declarations)
      rows.insert({type.heading(), name, declaration.text(), declaration.fallbackText(), type.type});
  return rows;
}

void addRowsOfPage(const char* page, Rows& rows) {
  std::string heading;
  std::ifstream stream(page);
  for (std::string line; std::getline(stream, line);) {
    if (begins(line, "## ")) heading = line.substr(3);
    const std::vector<std::string> cells =
        begins(line, "| `") ? cellsOfRow(line) : std::vector<std::string>();
    if (cells.size() != 4) continue;
    std::istringstream types(cells[3]);
    for (std::string type; std::getline(types, type, ',');)
      rows.insert({heading, cells[0].substr(1, cells[0].size() - 2), cells[1], cells[2],
                   type.substr(type.find_first_not_of(' '))});
  }
}

Rows rowsOfManual() {
  Rows rows;
  addRowsOfPage(ODIS_SOURCE "/docs/scene-parameters.md", rows);
  addRowsOfPage(ODIS_SOURCE "/docs/scene-parameters-bsdfs.md", rows);
  return rows;
}

std::string textOf(const std::array<std::string, 5>& row) {
  return fmt::format("{} | {} | {} | {} | {}", row[0], row[1], row[2], row[3], row[4]);
}

TEST(Parameters, AreAllInTheManual) {
  const Rows program = rowsOfProgram(), manual = rowsOfManual();
  for (const auto& row : program) EXPECT_TRUE(manual.count(row)) << "missing: " << textOf(row);
  for (const auto& row : manual) EXPECT_TRUE(program.count(row)) << "wrong: " << textOf(row);
}

}  // namespace
}  // namespace odis::test
