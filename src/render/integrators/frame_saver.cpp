#include "render/integrators/frame_saver.h"

#include <cstring>
#include <sstream>
#include <type_traits>

#include "render/files/read_json.h"

namespace odis::render {

namespace {

using nlohmann::json;

// What the renderer keeps with the frame: the length of a JSON text in bytes (64 bits, little-endian), the
// text, then the arrays of features and of the emission that camera rays met, and the films, as they lie in
// memory.
constexpr size_t kLengthBytes = 8;

template <class T>
void append(std::vector<uint8_t>& bytes, const std::vector<T>& elements) {
  // Imath's vectors are plain numbers, although they copy themselves by hand.
  static_assert(std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>);
  const auto* data = reinterpret_cast<const uint8_t*>(elements.data());
  bytes.insert(bytes.end(), data, data + elements.size() * sizeof(T));
}

std::vector<uint8_t> hostDataOf(const RenderJob& job, const SplatFilm* film) {
  const RenderStats& stats = job.stats;
  const std::string text =
      json{{"subject", job.options().saving.subject}, {"rays", stats.rays},
           {"shadowRays", stats.shadowRays},          {"secondsPilot", stats.secondsPilot},
           {"secondsBuild", stats.secondsBuild},      {"secondsGuided", stats.secondsGuided}}
          .dump();
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < kLengthBytes; ++i) bytes.push_back(uint8_t(uint64_t(text.size()) >> (8 * i)));
  bytes.insert(bytes.end(), text.begin(), text.end());
  append(bytes, job.features);
  append(bytes, job.guideFeatures);
  append(bytes, job.pilotEmitted);
  if (film) film->save(bytes);
  if (job.featureFilm) job.featureFilm->save(bytes);
  return bytes;
}

// Reads from the front of the host's data, never beyond its end.
class HostData {
 public:
  HostData(ArrayView<const uint8_t> bytes, const std::string& file) : m_bytes(bytes), m_file(file) {}

  json header() {
    require(m_bytes.size() >= kLengthBytes, "was not saved by `odis render`");
    uint64_t length = 0;
    for (size_t i = 0; i < kLengthBytes; ++i) length |= uint64_t(m_bytes[i]) << (8 * i);
    m_at = kLengthBytes;
    require(length <= m_bytes.size() - m_at, "was not saved by `odis render`");
    const std::string_view text(reinterpret_cast<const char*>(m_bytes.data() + m_at), size_t(length));
    m_at += size_t(length);
    try {
      return parseJson<json>(text);
    } catch (const ReadError& error) {
      require(false, error.what());
    }
    return {};
  }
  template <class T>
  void read(std::vector<T>& elements) {
    const size_t size = elements.size() * sizeof(T);
    require(size <= m_bytes.size() - m_at, "lacks what the renderer summed up");
    if (size > 0) std::memcpy(static_cast<void*>(elements.data()), m_bytes.data() + m_at, size);
    m_at += size;
  }
  void read(SplatFilm& film) {
    std::span<const uint8_t> rest(m_bytes.data() + m_at, m_bytes.size() - m_at);
    require(film.restore(rest), "lacks the film that the renderer summed up, or it is damaged");
    m_at = m_bytes.size() - rest.size();
  }
  void require(bool holds, const std::string& what) const {
    if (!holds) throw Error(ODIS_ERROR_FILE, m_file + ": " + what);
  }

 private:
  ArrayView<const uint8_t> m_bytes;
  size_t m_at = 0;
  const std::string& m_file;
};

// Complains of the first line in which two renderings differ.
void requireSame(const std::string& saved, const std::string& asked, const std::string& file) {
  std::istringstream there(saved), here(asked);
  std::string was, is;
  do {
    was.clear();
    is.clear();
    std::getline(there, was);
    std::getline(here, is);
  } while (was == is && (there || here));
  if (was != is)
    throw OptionError("--resume: " + file + " is of another rendering, found \"" + was + "\", expected \"" +
                      is + "\"");
}

void restore(RenderJob& job, SplatFilm* film, const odis::Frame& frame, const std::string& file) {
  HostData data(frame.hostData(), file);
  const json header = data.header();
  RenderStats& stats = job.stats;
  try {
    requireSame(header.at("subject").get<std::string>(), job.options().saving.subject, file);
    stats.rays = wholeNumber(header.at("rays"));
    stats.shadowRays = wholeNumber(header.at("shadowRays"));
    stats.secondsPilot = header.at("secondsPilot").get<double>();
    stats.secondsBuild = header.at("secondsBuild").get<double>();
    stats.secondsGuided = header.at("secondsGuided").get<double>();
  } catch (const json::exception& error) {
    data.require(false, jsonReason(error));
  }
  const FrameStatistics size = frame.statistics();
  const Crop& sampled = job.tiles().sampled();
  data.require(size.width == uint32_t(sampled.width) && size.height == uint32_t(sampled.height),
               "has another size than it says");
  data.read(job.features);
  data.read(job.guideFeatures);
  data.read(job.pilotEmitted);
  if (film) data.read(*film);
  if (job.featureFilm) data.read(*job.featureFilm);
}

}  // namespace

odis::Frame FrameSaver::begin(const FrameOptions& options) {
  if (m_options.resumeFrom.empty()) return odis::Frame(options);
  odis::Frame frame = odis::Frame::load(m_options.resumeFrom, options.guide.model);
  restore(m_job, m_film, frame, m_options.resumeFrom);
  return frame;
}

bool FrameSaver::isDue() const {
  const std::chrono::duration<double> since = Clock::now() - m_last;
  return m_news && !m_options.file.empty() && since.count() > m_options.everySeconds;
}

void FrameSaver::save(odis::Frame& frame) {
  if (!m_news || m_options.file.empty()) return;
  m_news = false;
  try {
    frame.setHostData(hostDataOf(m_job, m_film));
    frame.save(m_options.file);
  } catch (const Error& error) {
    m_job.progress().warn(error.what());
  }
  m_last = Clock::now();
}

}  // namespace odis::render
