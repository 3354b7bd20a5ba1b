#include "learn/train/config.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "render/files/read_json.h"
#include "render/math/interval.h"
#include "render/xml/names.h"

namespace odis::learn {

namespace {

constexpr std::pair<Loss, const char*> kLosses[] = {{Loss::crossEntropy, "cross-entropy"},
                                                    {Loss::logVariance, "log-variance"},
                                                    {Loss::l1, "l1"},
                                                    {Loss::l2, "l2"},
                                                    {Loss::log, "log"}};

constexpr std::pair<Network, const char*> kNetworks[] = {{Network::cells, "cells"},
                                                         {Network::pixels, "pixels"}};

constexpr std::pair<core::IncidentRadiance, const char*> kRadiances[] = {
    {core::IncidentRadiance::full, "full"}, {core::IncidentRadiance::withoutDirect, "without-direct"}};

constexpr std::pair<Precision, const char*> kPrecisions[] = {{Precision::single, "single"},
                                                             {Precision::mixed, "mixed"}};

template <class T, size_t N>
const char* nameOf(T value, const std::pair<T, const char*> (&words)[N]) {
  for (const auto& [which, name] : words)
    if (which == value) return name;
  return "";
}

// Takes values out of a JSON object and knows which keys it has been asked for.
class Keys {
 public:
  Keys(const std::string& path, const nlohmann::json& json) : m_path(path), m_left(json) {}

  void take(const char* key, std::string& value) {
    m_known.push_back(key);
    if (const auto found = m_left.find(key); found != m_left.end()) {
      if (!found->is_string()) fail(key, "expected a text");
      value = found->get<std::string>();
      m_left.erase(found);
    }
  }
  template <class T>
  void take(const char* key, T& value, T least, T most) {
    m_known.push_back(key);
    if (const auto found = m_left.find(key); found != m_left.end()) {
      const render::Interval<T> range{least, most};
      const bool fits = std::is_integral_v<T> ? found->is_number_integer() : found->is_number();
      // Whole numbers are within what a double holds exactly.
      const double number = fits ? found->template get<double>() : 0;
      if (!fits || !(number >= double(least) && number <= double(most)))
        fail(key, fmt::format("found {}, expected {} from {}", found->dump(),
                              std::is_integral_v<T> ? "a whole number" : "a number", range.text()));
      value = T(number);
      m_left.erase(found);
    }
  }
  // An object of texts.
  void take(const char* key, std::vector<std::pair<std::string, std::string>>& texts) {
    m_known.emplace_back(key);
    const auto found = m_left.find(key);
    if (found == m_left.end()) return;
    if (!found->is_object()) fail(key, "found " + found->dump() + ", expected an object of texts");
    for (const auto& [name, text] : found->items()) {
      if (!text.is_string()) fail(key, fmt::format("{}: found {}, expected a text", name, text.dump()));
      texts.emplace_back(name, text.get<std::string>());
    }
    m_left.erase(found);
  }
  // One of several words.
  template <class T, size_t N>
  void take(const char* key, T& value, const std::pair<T, const char*> (&words)[N]) {
    std::string word = nameOf(value, words), expected;
    take(key, word);
    for (const auto& [which, name] : words) {
      if (word == name) {
        value = which;
        return;
      }
      expected += (expected.empty() ? "" : ", ") + std::string(name);
    }
    fail(key, "found " + word + ", expected one of " + expected);
  }
  [[noreturn]] void fail(const std::string& key, const std::string& why) const {
    throw ConfigError(fmt::format("{}: {}: {}", m_path, key, why));
  }
  void expectNoneLeft() const {
    if (m_left.empty()) return;
    const std::string& key = m_left.begin().key();
    fail(key, "is no key of a training" + render::suggestion(key, m_known) + ", see docs/network.md");
  }

 private:
  const std::string& m_path;
  nlohmann::json m_left;
  std::vector<std::string> m_known;
};

}  // namespace

TrainConfig readConfig(const std::string& path) {
  nlohmann::json json;
  try {
    json = render::readJson<nlohmann::json>(path);
  } catch (const render::ReadError& error) {
    throw ConfigError(path + ": cannot be read: " + error.what());
  }
  if (!json.is_object()) throw ConfigError(path + ": expected an object");
  constexpr int kMany = 1 << 30;
  TrainConfig c;
  Keys keys(path, json);
  keys.take("data", c.data);
  keys.take("examples", c.examples);
  keys.take("shards", c.shards, 1, kMany);
  keys.take("network", c.network, kNetworks);
  keys.take("steps", c.steps, 1, kMany);
  keys.take("batch", c.batch, 1, 1 << 20);
  keys.take("hidden", c.hidden, 1, 256);
  keys.take("loss", c.loss, kLosses);
  keys.take("fineTuneSteps", c.fineTuneSteps, 0, kMany);
  keys.take("learningRate", c.learningRate, 0.0, 1.0);
  keys.take("finalLearningRate", c.finalLearningRate, 0.0, 1.0);
  keys.take("warmUpSteps", c.warmUpSteps, 0, kMany);
  keys.take("shiftProbability", c.shiftProbability, 0.0, 1.0);
  keys.take("roundSteps", c.roundSteps, 1, kMany);
  keys.take("validateSteps", c.validateSteps, 1, kMany);
  keys.take("validationScenes", c.validationScenes, 0, kMany);
  keys.take("seed", c.seed, 0, kMany);
  keys.take("width", c.width, 8, 64);
  keys.take("tile", c.tile, 1, 8);
  keys.take("radiance", c.radiance, kRadiances);
  keys.take("adversarialWeight", c.adversarialWeight, 0.0, 1e6);
  keys.take("adversarialStart", c.adversarialStart, 0, kMany);
  keys.take("adversarialFull", c.adversarialFull, 0, kMany);
  keys.take("discriminatorRate", c.discriminatorRate, 0.0, 1.0);
  keys.take("beside", c.beside);
  keys.take("precision", c.precision, kPrecisions);
  keys.take("device", c.device);
  if (c.device != "auto" && c.device != "cpu" && c.device != "cuda")
    keys.fail("device", "found " + c.device + ", expected auto, cpu or cuda");
  if (c.width % 8 != 0) keys.fail("width", fmt::format("found {}, expected a multiple of 8", c.width));
  if (c.adversarialFull < c.adversarialStart)
    keys.fail("adversarialFull", fmt::format("found {}, expected at least adversarialStart, {}",
                                             c.adversarialFull, c.adversarialStart));
  if (c.network == Network::cells && c.loss == Loss::log)
    keys.fail("loss", "found log, which is for the network at pixels alone");
  keys.expectNoneLeft();
  if (c.data.empty()) keys.fail("data", "is missing, expected a folder of shards");
  // Paths are relative to the file that names them.
  const std::filesystem::path base = std::filesystem::path(path).parent_path();
  c.data = (base / c.data).lexically_normal().string();
  if (!c.examples.empty()) c.examples = (base / c.examples).lexically_normal().string();
  for (auto& [name, weights] : c.beside) weights = (base / weights).lexically_normal().string();
  return c;
}

nlohmann::ordered_json toJson(const TrainConfig& c) {
  nlohmann::ordered_json beside = nlohmann::ordered_json::object();
  for (const auto& [name, weights] : c.beside) beside[name] = weights;
  return {{"data", c.data},
          {"examples", c.examples},
          {"shards", c.shards},
          {"network", nameOf(c.network, kNetworks)},
          {"steps", c.steps},
          {"batch", c.batch},
          {"hidden", c.hidden},
          {"loss", nameOf(c.loss, kLosses)},
          {"fineTuneSteps", c.fineTuneSteps},
          {"learningRate", c.learningRate},
          {"finalLearningRate", c.finalLearningRate},
          {"warmUpSteps", c.warmUpSteps},
          {"shiftProbability", c.shiftProbability},
          {"roundSteps", c.roundSteps},
          {"validateSteps", c.validateSteps},
          {"validationScenes", c.validationScenes},
          {"seed", c.seed},
          {"width", c.width},
          {"tile", c.tile},
          {"radiance", nameOf(c.radiance, kRadiances)},
          {"adversarialWeight", c.adversarialWeight},
          {"adversarialStart", c.adversarialStart},
          {"adversarialFull", c.adversarialFull},
          {"discriminatorRate", c.discriminatorRate},
          {"beside", beside},
          {"precision", nameOf(c.precision, kPrecisions)},
          {"device", c.device}};
}

}  // namespace odis::learn
