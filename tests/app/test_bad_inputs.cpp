// The list of bad inputs in tests/app/bad_inputs: every case is refused, or survived, as it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "file_content.h"
#include "limited_process.h"
#include "support/sanitizers.h"
#include "support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace odis::test;

// A case's own elements come first, so that its own sensor counts.
constexpr const char* kSceneBegin = "<scene version=\"3.0.0\">\n";
constexpr const char* kSceneEnd = R"(
  <sensor type="perspective">
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film>
    <sampler type="independent"><integer name="sample_count" value="2"/></sampler>
  </sensor>
  <emitter type="constant"/>
</scene>
)";
constexpr const char* kSphere = R"(  <shape type="sphere"><point name="center" x="0" y="0" z="4"/></shape>)";

// Makes the files of a case in `folder`; throws if the case itself is wrong.
void makeFiles(const json& given, const TemporaryFolder& folder) {
  const auto write = [&](const std::string& name, const std::string& bytes) {
    fs::create_directories(fs::path(folder.path(name)).parent_path());
    std::ofstream(folder.path(name), std::ios::binary) << bytes;
  };
  write("room.xml", std::string(kSceneBegin) + kSphere + kSceneEnd);
  if (given.contains("scene")) write("scene.xml", kSceneBegin + contentOf(given.at("scene")) + kSceneEnd);
  if (given.contains("files"))
    for (const auto& [name, content] : given.at("files").items()) write(name, contentOf(content));
  if (!given.contains("setup")) return;
  const ProcessEnd end =
      runWithLimits(folder.path(""), "ODIS='" ODIS_COMMAND "'; " + given.at("setup").get<std::string>(), {});
  if (end.code != 0) throw std::runtime_error("the setup fails: " + end.text);
}

// What tells of each file below a folder whether it was touched.
std::map<std::string, std::string> snapshot(const std::string& folder) {
  std::map<std::string, std::string> result;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    std::ostringstream text;
    const fs::file_status status = entry.symlink_status();
    text << "type " << int(status.type());
    if (fs::is_symlink(status)) text << " to " << fs::read_symlink(entry.path());
    if (fs::is_regular_file(status))
      text << ", " << entry.file_size() << " bytes, " << entry.last_write_time().time_since_epoch().count();
    result[entry.path().lexically_relative(folder)] = text.str();
  }
  return result;
}

std::string differences(const std::map<std::string, std::string>& before,
                        const std::map<std::string, std::string>& after, const json& allowed) {
  std::string result;
  const auto note = [&](const std::string& name, const char* what) {
    if (std::find(allowed.begin(), allowed.end(), name) == allowed.end())
      result += "  " + name + " was " + what + "\n";
  };
  for (const auto& [name, text] : before)
    if (!after.count(name))
      note(name, "removed");
    else if (after.at(name) != text)
      note(name, "changed");
  for (const auto& [name, text] : after)
    if (!before.count(name)) note(name, "left");
  return result;
}

// How many lines begin with "error: ".
int errorCount(const std::string& text) {
  int count = 0;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) count += line.rfind("error: ", 0) == 0;
  return count;
}

// What of the outcome is not as the case says; empty if all is.
std::string complaintsOf(const json& given, const ProcessEnd& end) {
  std::string result;
  if (end.timedOut) result += "  took too long\n";
  if (end.signal != 0) result += "  was ended by signal " + std::to_string(end.signal) + "\n";
  if (!end.timedOut && end.code != given.at("code"))
    result += "  the code is " + std::to_string(end.code) + ", expected " + given.at("code").dump() + "\n";
  const json& message = given.at("message");
  for (const json& part : message.is_array() ? message : json::array({message}))
    if (end.text.find(part.get<std::string>()) == std::string::npos)
      result += "  the message has no \"" + part.get<std::string>() + "\"\n";
  if ((errorCount(end.text) > 0) != (given.at("code") != 0))
    result += "  " + std::to_string(errorCount(end.text)) + " lines begin with \"error: \"\n";
  return result;
}

std::string failureOf(const json& given) {
  constexpr uint64_t kMostAddresses = uint64_t(2) << 30;
  try {
    const TemporaryFolder folder;
    makeFiles(given, folder);
    const auto before = snapshot(folder.path(""));
    // Every thread of a machine with many cores would have an arena of its own.
    const std::string command = "MALLOC_ARENA_MAX=2 exec '" ODIS_COMMAND "' " +
                                given.value("arguments", std::string("render scene.xml -q"));
    const Limits limits{kSanitized ? 0 : kMostAddresses, std::chrono::seconds(kSanitized ? 120 : 20)};
    const ProcessEnd end = runWithLimits(folder.path(""), command, limits);
    if (given.value("needs", std::string()) == "libtorch" &&
        end.text.find("libtorch is missing") != std::string::npos)
      return "";
    const std::string complaints =
        complaintsOf(given, end) +
        differences(before, snapshot(folder.path("")), given.value("leaves", json::array()));
    return complaints.empty() ? "" : complaints + "  it printed: " + end.text.substr(0, 2000);
  } catch (const std::exception& error) {
    return std::string("  ") + error.what();
  }
}

std::vector<std::string> areas() {
  std::vector<std::string> result;
  for (const fs::directory_entry& entry : fs::directory_iterator(ODIS_SOURCE "/tests/app/bad_inputs"))
    if (entry.path().extension() == ".json") result.push_back(entry.path().stem());
  std::sort(result.begin(), result.end());
  return result;
}

class BadInputs : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, BadInputs, testing::ValuesIn(areas()),
                         [](const testing::TestParamInfo<std::string>& info) { return info.param; });

TEST_P(BadInputs, AreRefusedAsTheListSays) {
  std::ifstream stream(ODIS_SOURCE "/tests/app/bad_inputs/" + GetParam() + ".json");
  const json cases = json::parse(stream);
  std::vector<std::string> failures(cases.size());
  std::map<std::string, int> names;
  for (const json& given : cases) EXPECT_EQ(names[given.at("name")]++, 0) << "a second " << given.at("name");

  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t i = next++; i < cases.size(); i = next++) failures[i] = failureOf(cases[i]);
  };
  std::thread other(work);
  work();
  other.join();
  for (size_t i = 0; i < cases.size(); ++i)
    if (!failures[i].empty()) ADD_FAILURE() << cases[i].at("name") << ":\n" << failures[i];
}

}  // namespace
