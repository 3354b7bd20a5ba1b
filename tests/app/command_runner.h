// The built command, run in a folder of its own that holds a small scene.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace odis::test {

struct Outcome {
  int code = -1;
  std::string text;  // stdout and stderr
};

class Odis : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "odis-test-XXXXXX").string();
    m_folder = mkdtemp(pattern.data());
    write("room.xml", R"(<scene version="3.0.0">
  <default name="radiance" value="1"/>
  <sensor type="perspective">
    <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="8"/></film>
    <sampler type="independent"><integer name="sample_count" value="2"/></sampler>
  </sensor>
  <shape type="sphere"><point name="center" x="0" y="0" z="4"/></shape>
  <emitter type="constant"><float name="radiance" value="$radiance"/></emitter>
</scene>)");
  }
  void TearDown() override { std::filesystem::remove_all(m_folder); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(m_folder / name) << text;
  }
  std::filesystem::path file(const std::string& name) const { return m_folder / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(m_folder / name); }

  // Runs `odis` with these arguments in the temporary folder.
  Outcome run(const std::string& arguments) const { return runShell("'" ODIS_COMMAND "' " + arguments); }
  Outcome runShell(const std::string& script) const {
    const std::string command = "exec 2>&1; cd '" + m_folder.string() + "' || exit 99; " + script;
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 512> buffer;
    while (const size_t count = fread(buffer.data(), 1, buffer.size(), pipe))
      outcome.text.append(buffer.data(), count);
    const int status = pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
  }
  void expectFailure(const std::string& arguments, int code, const std::string& message) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.text;
    EXPECT_NE(outcome.text.find(message), std::string::npos) << arguments << "\n" << outcome.text;
  }

  std::filesystem::path m_folder;
};

}  // namespace odis::test
