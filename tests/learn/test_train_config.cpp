// Every key of a training: what is out of its range or of another kind is refused, with its name.
#include <gtest/gtest.h>

#include <fstream>

#include "learn/train/config.h"
#include "support/temporary_folder.h"

namespace odis::learn {
namespace {

TEST(TrainConfigKeys, AreRefusedOutsideOfTheirRanges) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("config.json");
  const auto complaint = [&](const std::string& key, const std::string& value) -> std::string {
    const std::string data = key == "data" ? "" : "\"data\": \"shards\", ";
    std::ofstream(path) << "{" + data + "\"" + key + "\": " + value + "}";
    try {
      readConfig(path);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  const nlohmann::ordered_json defaults = toJson(TrainConfig());
  for (const auto& [key, value] : defaults.items()) {
    std::vector<std::string> wrong = {"null", "true", "[]", value.is_object() ? "{\"L1\": 1}" : "{}"};
    if (value.is_number())
      wrong.insert(wrong.end(), {"-1", "1e300", "-1e300", "99999999999999999999", "\"1\""});
    if (value.is_number_integer()) wrong.push_back("1.5");
    if (value.is_string()) wrong.push_back("1");
    for (const std::string& text : wrong)
      EXPECT_EQ(complaint(key, text).rfind(path + ": " + key + ": ", 0), 0u)
          << key << " " << text << ": " << complaint(key, text);
  }
  EXPECT_GT(defaults.size(), 15u);
  EXPECT_NE(complaint("batches", "1").find("is no key of a training (did you mean 'batch'?)"),
            std::string::npos);
}

}  // namespace
}  // namespace odis::learn
