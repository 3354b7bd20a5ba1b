#include "eval/results_log.h"

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "render/files/read_json.h"
#include "render/files/replace_file.h"

namespace odis::eval {

// JSON has no infinity; nlohmann writes null.
static double numberOrInfinity(const nlohmann::json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::infinity();
}

static Measurement fromJson(const nlohmann::json& json) {
  Measurement m;
  m.scene = json.at("scene");
  m.method = json.at("method");
  m.spp = json.at("spp");
  m.equalTime = json.at("equalTime");
  m.denoised = json.at("denoised");
  m.seed = json.at("seed");
  m.key = json.at("key");
  m.error.mse = numberOrInfinity(json.at("mse"));
  m.error.relMse = numberOrInfinity(json.at("relMse"));
  m.error.trimmedRelMse = numberOrInfinity(json.at("trimmedRelMse"));
  m.error.smape = numberOrInfinity(json.at("smape"));
  m.error.mean = json.at("mean");
  m.error.flip = json.at("flip");
  m.error.ssim = json.at("ssim");
  m.error.nonFinitePixels = json.at("nonFinitePixels");
  m.seconds = json.at("seconds");
  m.cpuSeconds = json.at("cpuSeconds");
  m.samples = json.at("samples");
  m.rays = json.at("rays");
  m.image = json.at("image");
  return m;
}

nlohmann::ordered_json measurementJson(const Measurement& m) {
  return {{"scene", m.scene},
          {"method", m.method},
          {"spp", m.spp},
          {"equalTime", m.equalTime},
          {"denoised", m.denoised},
          {"seed", m.seed},
          {"samples", m.samples},
          {"relMse", m.error.relMse},
          {"trimmedRelMse", m.error.trimmedRelMse},
          {"smape", m.error.smape},
          {"mse", m.error.mse},
          {"mean", m.error.mean},
          {"flip", m.error.flip},
          {"ssim", m.error.ssim},
          {"nonFinitePixels", m.error.nonFinitePixels},
          {"seconds", m.seconds},
          {"cpuSeconds", m.cpuSeconds},
          {"rays", m.rays},
          {"image", m.image},
          {"key", m.key}};
}

ResultsLog::ResultsLog(std::string path, bool fresh) : m_path(std::move(path)) {
  if (fresh) std::filesystem::remove(m_path);
  if (!std::filesystem::exists(m_path)) return;
  std::istringstream stream;
  try {
    stream.str(render::readFile(m_path));
  } catch (const render::ReadError& error) {
    throw render::WriteError("cannot add results to \"" + m_path + "\": " + error.what());
  }
  for (std::string line; std::getline(stream, line);) {
    try {
      Measurement measurement = fromJson(render::parseJson<nlohmann::json>(line));
      m_byKey[measurement.key] = measurement;
    } catch (const render::ReadError&) {
      continue;  // cut off by a crash: rendered again
    } catch (const nlohmann::json::exception&) {
      continue;  // of another version
    }
  }
}

const Measurement* ResultsLog::find(const std::string& key) const {
  const auto found = m_byKey.find(key);
  return found == m_byKey.end() ? nullptr : &found->second;
}

void ResultsLog::add(const Measurement& measurement) {
  std::ofstream stream(m_path, std::ios::app);
  stream << measurementJson(measurement).dump() << '\n';
  stream.close();
  if (!stream) throw render::WriteError("cannot write \"" + m_path + "\"");
  m_byKey[measurement.key] = measurement;
}

}  // namespace odis::eval
