// What messages name exists, under the names that hosts know.
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "api/api_scene.h"

namespace odis::test {
namespace {

std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// All string literals of the library's sources that match.
std::vector<std::string> literalsWith(const std::regex& pattern) {
  static const std::regex literal(R"("(?:[^"\\\n]|\\.)*")");
  std::vector<std::string> found;
  for (const auto& file : std::filesystem::recursive_directory_iterator(ODIS_SOURCE "/src/odis")) {
    if (file.path().extension() != ".cpp" && file.path().extension() != ".h") continue;
    const std::string text = contentOf(file.path());
    for (std::sregex_iterator i(text.begin(), text.end(), literal), end; i != end; ++i) {
      const std::string value = i->str();
      // A separate library has these two, which no message names.
      if (value == "\"odisMakePixelConvolutions\"" || value == "\"odisPixelWeights\"") continue;
      for (std::sregex_iterator j(value.begin(), value.end(), pattern), none; j != none; ++j)
        found.push_back((*j)[1]);
    }
  }
  return found;
}

TEST(ApiMessages, NameFunctionsThatExist) {
  const std::string interface = contentOf(ODIS_SOURCE "/src/odis/api/abi.txt");
  const std::vector<std::string> names = literalsWith(std::regex("\\b(odis[A-Z]\\w*)"));
  EXPECT_GT(names.size(), 50u);
  for (const std::string& name : names)
    EXPECT_NE(interface.find(name + "("), std::string::npos) << name << " is no function of the interface";
}

TEST(ApiMessages, NameNoConstantsOfTheSources) {
  EXPECT_EQ(literalsWith(std::regex("\\b(k[A-Z]\\w*|k?Max[A-Z]\\w*)")), std::vector<std::string>());
}

// What a call leaves as its message.
template <class Call>
std::string messageOf(const Call& call) {
  call();
  std::string message;
  EXPECT_EQ(takeError(&message), ODIS_ERROR_INVALID_ARGUMENT);
  return message;
}

TEST(ApiMessages, SayWhatToDoAboutASizeByTheNameOfTheStruct) {
  const Context context;
  OdisFrameOptions options;
  options.size = 3;
  EXPECT_NE(messageOf([&] { odisNewFrame(context.get(), &options); }).find("odisInitFrameOptions()"),
            std::string::npos);
  OdisSetting setting;
  setting.size = 3;
  EXPECT_NE(messageOf([&] { odisGetSetting(0, &setting); }).find("sizeof(OdisSetting)"), std::string::npos);
  PathRecorder recorder(context);
  const uint32_t path = recorder.begin({});
  OdisLightEvent light;
  light.size = 3;
  EXPECT_NE(messageOf([&] { odisRecordLight(recorder.get(), path, &light); }).find("odisInitLightEvent()"),
            std::string::npos);
  EXPECT_NE(messageOf([&] { odisInitLightEvent(&light, 3); }).find("sizeof(OdisLightEvent)"),
            std::string::npos);
}

TEST(ApiMessages, SayHowManyGroupsOfLightsThereMayBe) {
  GuideOptions options;
  options.lightGroups = 140;
  try {
    const GuideBuilder builder(options);
    FAIL() << "140 groups are taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("at most 128, found 140"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace odis::test
