// Every option of every command that takes a number: its range stands in the help, and what is not in it is
// refused.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <regex>

#include "command.h"
#include "settings.h"

namespace {

using odis::app::Setting;

// Numbers beside the range "LEAST to MOST", and what is no number at all.
std::vector<std::string> wrongFor(const std::string& least, const std::string& most, bool whole) {
  std::vector<std::string> wrong = {"nan",  "-nan", "inf", "-inf", "",   "many",
                                    "1e99", "0x7",  "1 2", "1,2",  "--5"};
  if (whole) wrong.insert(wrong.end(), {"1.5", "2.0", "99999999999999999999999", "1e1", least + ".0"});
  wrong.push_back(fmt::format("{}", std::stod(least) - std::max(1.0, std::abs(std::stod(least)))));
  // Next to the largest whole numbers a double has no room.
  if (std::stod(most) < 1e15)
    wrong.push_back(fmt::format("{}", std::stod(most) + std::max(1.0, std::stod(most) / 2)));
  return wrong;
}

struct Ends {
  std::string least, most;
};

// The ends of a range as help shows it.
std::optional<Ends> endsOf(const std::string& text) {
  static const std::regex range(R"((-?[0-9][-+0-9.e]*) to ([0-9][-+0-9.e]*)$)");
  std::smatch found;
  if (!std::regex_search(text, found, range)) return {};
  return Ends{found[1], found[2]};
}

// All commands that take options, the innermost ones.
void collectCommands(CLI::App& app, std::vector<CLI::App*>& commands) {
  const std::vector<CLI::App*> nested = app.get_subcommands([](CLI::App*) { return true; });
  if (nested.empty()) commands.push_back(&app);
  for (CLI::App* command : nested) collectCommands(*command, commands);
}

std::string argumentsUpTo(const CLI::App* command) {
  std::string words = command->get_name();
  for (const CLI::App* parent = command->get_parent(); parent->get_parent(); parent = parent->get_parent())
    words = parent->get_name() + " " + words;
  return words;
}

// What the program says to an option; empty if it takes it.
std::string complaintAboutOption(const CLI::App* command, const std::string& option,
                                 const std::string& value) {
  CLI::App app("odis", "odis");
  const auto known = odis::app::addCommands(app, "");  // hold what options are stored in
  std::istringstream words(argumentsUpTo(command));
  std::vector<std::string> arguments = {option + "=" + value};  // CLI11 wants them backwards
  for (std::string word; words >> word;) arguments.insert(arguments.begin() + 1, word);
  try {
    app.parse(arguments);
  } catch (const CLI::RequiredError&) {
    return "";
  } catch (const CLI::ParseError& error) {
    return error.what();
  }
  return "";
}

TEST(Options, ThatTakeNumbersHaveRanges) {
  CLI::App app("odis", "odis");
  const auto known = odis::app::addCommands(app, "");  // hold what options are stored in
  std::vector<CLI::App*> commands;
  collectCommands(app, commands);
  int count = 0;
  for (const CLI::App* command : commands)
    for (const CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      const bool whole = type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0;
      if (!whole && type.rfind("FLOAT", 0) != 0) continue;
      ++count;
      const std::string name = option->get_name(), where = argumentsUpTo(command) + " " + name + " " + type;
      const std::optional<Ends> ends = endsOf(type);
      ASSERT_TRUE(ends) << where;
      for (const std::string& value : wrongFor(ends->least, ends->most, whole)) {
        const std::string complaint = complaintAboutOption(command, name, value);
        EXPECT_NE(complaint.find(name + ":"), std::string::npos) << where << "=" << value << " " << complaint;
        if (!value.empty())
          EXPECT_NE(complaint.find(fmt::format("found {}, expected a {} from {} to {}", value,
                                               whole ? "whole number" : "number", ends->least, ends->most)),
                    std::string::npos)
              << where << "=" << value << " " << complaint;
      }
      for (const std::string& value : {ends->least, ends->most})
        EXPECT_EQ(complaintAboutOption(command, name, value), "") << where << "=" << value;
    }
  EXPECT_GT(count, 40);
}

TEST(Options, OfSetThatTakeNumbersHaveRanges) {
  int count = 0;
  for (const Setting& setting : odis::app::allSettings()) {
    if (!setting.option.empty()) continue;
    const std::optional<Ends> ends = endsOf(setting.values);
    const bool words = setting.values.find('|') != std::string::npos;
    EXPECT_NE(ends.has_value(), words) << setting.key;
    const auto complaint = [&](const std::string& value) -> std::string {
      odis::render::RenderOptions options;
      try {
        setting.set(options, value);
      } catch (const odis::app::UsageError& error) {
        return error.what();
      }
      return "";
    };
    EXPECT_NE(complaint("nonsense").find("--set " + setting.key + ": found \"nonsense\", expected"),
              std::string::npos);
    if (!ends) continue;
    ++count;
    for (const std::string& value : wrongFor(ends->least, ends->most, false))
      EXPECT_NE(complaint(value).find(ends->least + " to " + ends->most), std::string::npos)
          << setting.key << "=" << value;
    if (setting.key == "prior-samples") continue;
    for (const std::string& value : {ends->least, ends->most})
      EXPECT_EQ(complaint(value), "") << setting.key << "=" << value;
  }
  EXPECT_GT(count, 10);
}

}  // namespace
