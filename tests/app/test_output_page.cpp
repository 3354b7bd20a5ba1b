// docs/output.md names the channels, the header and the files that odis render writes, each with its option.
#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <map>
#include <set>
#include <sstream>

#include "command_runner.h"
#include "support/markdown_table.h"

namespace {

using odis::test::cellsOfRow;

// `names` in backquotes in a cell of the manual.
std::vector<std::string> namesIn(const std::string& cell) {
  std::vector<std::string> names;
  for (size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at)) {
    const size_t end = cell.find('`', at + 1);
    names.push_back(cell.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return names;
}

// The rows of the table below a heading, without the names of its columns.
std::vector<std::vector<std::string>> tableBelow(const std::string& heading) {
  std::ifstream stream(ODIS_SOURCE "/docs/output.md");
  std::vector<std::vector<std::string>> rows;
  bool below = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("## ", 0) == 0) below = line == "## " + heading;
    if (below && line.rfind("| `", 0) == 0) rows.push_back(cellsOfRow(line));
  }
  return rows;
}

class OutputPage : public odis::test::Odis {
 protected:
  // Name and type of the channels of an image, and the names of the attributes of the program.
  void render(const std::string& options) {
    const odis::test::Outcome outcome = run("render room.xml -q -o image.exr " + options);
    ASSERT_EQ(outcome.code, 0) << options << "\n" << outcome.text;
    const Imf::InputFile image(file("image.exr").c_str());
    m_channels.clear();
    m_attributes.clear();
    for (auto c = image.header().channels().begin(); c != image.header().channels().end(); ++c)
      m_channels[c.name()] = c.channel().type == Imf::HALF ? "half" : "float";
    for (auto a = image.header().begin(); a != image.header().end(); ++a)
      if (std::string(a.name()).rfind("odis:", 0) == 0) {
        m_attributes.insert(a.name());
        EXPECT_STREQ(a.attribute().typeName(), "string") << a.name();
      }
  }

  std::map<std::string, std::string> m_channels;
  std::set<std::string> m_attributes;
};

TEST_F(OutputPage, HasAllChannels) {
  std::map<std::string, std::map<std::string, std::string>> channels;  // by option
  std::set<std::string> options;
  for (const std::vector<std::string>& row : tableBelow("Channels")) {
    ASSERT_EQ(row.size(), 4u) << row[0];
    const std::string option = row[1] == "always" ? "" : namesIn(row[1]).at(0);
    options.insert(option);
    for (const std::string& name : namesIn(row[0])) channels[option][name] = row[2];
  }
  EXPECT_EQ(options.size(), 10u);
  const bool denoises = run("render room.xml -q --denoise -o denoised.exr").code == 0;
  for (const std::string& option : options) {
    if (option == "--denoise" && !denoises) continue;
    std::map<std::string, std::string> expected = channels[""];
    expected.insert(channels[option].begin(), channels[option].end());
    if (option == "--denoise")
      for (const char* told : {"--aov albedo", "--aov normal"})
        expected.insert(channels[told].begin(), channels[told].end());
    render(option);
    EXPECT_EQ(m_channels, expected) << option;
  }
  // Nothing is written that no row names.
  std::map<std::string, std::string> all;
  for (const auto& [option, named] : channels)
    if (option != "--denoise") all.insert(named.begin(), named.end());
  render("--aov all --variance");
  EXPECT_EQ(m_channels, all);
}

TEST_F(OutputPage, HasAllAttributesOfTheHeader) {
  std::set<std::string> always, denoised, odis;
  for (const std::vector<std::string>& row : tableBelow("Header")) {
    ASSERT_EQ(row.size(), 2u) << row[0];
    for (const std::string& name : namesIn(row[0]))
      (row[1].rfind("with `--denoise`", 0) == 0           ? denoised
       : row[1].rfind("with `--integrator odis`", 0) == 0 ? odis
                                                          : always)
          .insert(name);
  }
  render("--integrator path");
  EXPECT_EQ(m_attributes, always);
  render("");
  always.merge(odis);
  EXPECT_EQ(m_attributes, always);
  if (run("render room.xml -q --denoise -o denoised.exr").code != 0) GTEST_SKIP() << "without a denoiser";
  render("--denoise");
  always.merge(denoised);
  EXPECT_EQ(m_attributes, always);
}

TEST_F(OutputPage, HasAllFiles) {
  std::set<std::string> files;
  for (const std::vector<std::string>& row : tableBelow("Files beside the image"))
    files.insert(namesIn(row[0]).at(0));
  EXPECT_EQ(files, (std::set<std::string>{"--png FILE", "--stats-json FILE", "--records FILE",
                                          "--save-every MINUTES"}));
  render("--png look.png --stats-json cost.json --records pilot.npy");
  EXPECT_TRUE(exists("look.png") && exists("cost.json") && exists("pilot.npy"));
}

}  // namespace
