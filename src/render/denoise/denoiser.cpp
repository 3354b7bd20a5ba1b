#include "render/denoise/denoiser.h"

#include <fmt/format.h>
#include <half.h>

#include <atomic>
#include <memory>
#include <stdexcept>

#include "render/denoise/color_range.h"
#include "render/denoise/margin.h"

namespace odis::render {

namespace {

constexpr int kOldestVersion = 10400;  // two digits each of major, minor and patch; older ones lack cleanAux

float clampFinite(float value, float least, float most) {
  return std::isfinite(value) ? std::clamp(value, least, most) : 0.0f;
}

// In the 16 bits that files hold, so that an image and its file are denoised alike.
template <typename Vector>
std::vector<Vec3> cleanFeatures(std::span<const Vector> values, float least) {
  std::vector<Vec3> clean;
  clean.reserve(values.size());
  for (const Vector& value : values) {
    Vec3& out = clean.emplace_back();
    for (int i = 0; i < 3; ++i) out[i] = float(Imath::half(clampFinite(value[i], least, 1)));
  }
  return clean;
}

// Passes on how far several filters have come, one after another.
struct Monitor {
  Progress& progress;
  uint64_t pixels;                // of one filter
  std::atomic<uint64_t> done{0};  // by the one that runs

  static bool report(void* user, double share) {
    Monitor& monitor = *static_cast<Monitor*>(user);
    const auto done = uint64_t(std::clamp(share, 0.0, 1.0) * double(monitor.pixels));
    uint64_t before = monitor.done.load();
    while (done > before && !monitor.done.compare_exchange_weak(before, done)) {
    }
    if (done > before) monitor.progress.advance(done - before);
    return !monitor.progress.cancelled();
  }
};

// One filter of the library, which is made, run and released.
class Filter {
 public:
  Filter(const OidnLibrary& oidn, OidnDevice* device, const Margin& size)
      : m_oidn(oidn), m_filter(oidn.newFilter(device, "RT")), m_size(size) {
    m_oidn.setFilterInt(m_filter, "maxMemoryMB", kDenoiserMegabytes);
  }
  ~Filter() { m_oidn.releaseFilter(m_filter); }
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;

  template <typename Vector>
  void image(const char* name, std::vector<Vector>& pixels) {
    if (pixels.empty()) return;
    m_oidn.setSharedFilterImage(m_filter, name, pixels.data(), kOidnFloat3, size_t(m_size.width()),
                                size_t(m_size.height()), 0, sizeof(Vector), 0);
  }
  void flag(const char* name, bool value) { m_oidn.setFilterBool(m_filter, name, value); }
  void run(Monitor& monitor) {
    monitor.done = 0;
    m_oidn.setProgressFunction(m_filter, Monitor::report, &monitor);
    m_oidn.commitFilter(m_filter);
    m_oidn.executeFilter(m_filter);
  }

 private:
  const OidnLibrary& m_oidn;
  OidnFilter* m_filter;
  const Margin& m_size;
};

void requireSizes(const DenoiserInput& input) {
  const size_t pixels = size_t(input.width) * size_t(input.height);
  const auto fits = [&](size_t count) { return count == 0 || count == pixels; };
  if (pixels == 0 || input.color.size() != pixels || !fits(input.albedo.size()) || !fits(input.normal.size()))
    throw std::invalid_argument("images to denoise differ in size");
  if (input.albedo.empty() && !input.normal.empty())
    throw std::invalid_argument("normals are of use to the denoiser together with an albedo only");
}

bool usesBoth(const DenoiserInput& input) {
  return !input.albedo.empty() && !input.normal.empty();
}

}  // namespace

Denoiser::Denoiser(int threads) : m_oidn(oidnLibrary()), m_device(m_oidn.newDevice(kOidnCpu)) {
  const char* message = nullptr;
  if (!m_device) {
    m_oidn.getDeviceError(nullptr, &message);
    fail(message);
  }
  m_oidn.setDeviceInt(m_device, "numThreads", threads);
  m_oidn.setDeviceBool(m_device, "setAffinity", false);  // the threads are the renderer's as well
  m_oidn.commitDevice(m_device);
  const int version = m_oidn.getDeviceInt(m_device, "version");
  m_name = fmt::format("Open Image Denoise {}.{}.{}", version / 10000, version / 100 % 100, version % 100);
  const int code = m_oidn.getDeviceError(m_device, &message);
  if (code == kOidnNoError && version >= kOldestVersion) return;
  const std::string reason = code == kOidnNoError ? m_name + ": expected 1.4 or later" : message;
  m_oidn.releaseDevice(m_device);
  throw DenoiserError(m_oidn.path + ": " + reason);
}

Denoiser::~Denoiser() {
  m_oidn.releaseDevice(m_device);
}

void Denoiser::fail(const char* message) const {
  throw DenoiserError(fmt::format("{}: {}", m_name.empty() ? m_oidn.path : m_name,
                                  message ? message : "failed without a message"));
}

std::optional<std::vector<Rgb>> Denoiser::denoise(const DenoiserInput& input, Auxiliaries auxiliaries,
                                                  Progress& progress) const {
  requireSizes(input);
  const ColorRange range(input.color, input.width);
  const Margin margin(input.width, input.height);
  std::vector<Rgb> color = margin.add(range.colors());
  std::vector<Vec3> albedo, normal;
  if (auxiliaries != Auxiliaries::none) {
    albedo = margin.add(cleanFeatures(input.albedo, 0));
    normal = margin.add(cleanFeatures(input.normal, -1));
  }
  const bool prefiltered = auxiliaries == Auxiliaries::prefiltered && usesBoth(input);
  Monitor monitor{progress, color.size()};
  progress.begin("denoise", color.size() * (prefiltered ? 3 : 1), 0, "pixels");

  // Returns false if it was cancelled.
  const auto run = [&](Filter& filter) {
    filter.run(monitor);
    const char* message = nullptr;
    const int code = m_oidn.getDeviceError(m_device, &message);
    if (code == kOidnCancelled || progress.cancelled()) return false;
    if (code != kOidnNoError) fail(message);
    monitor.progress.advance(monitor.pixels - monitor.done);
    return true;
  };
  const auto prefilter = [&](const char* name, std::vector<Vec3>& pixels) {
    Filter filter(m_oidn, m_device, margin);
    filter.image(name, pixels);
    filter.image("output", pixels);
    return run(filter);
  };
  if (prefiltered && (!prefilter("albedo", albedo) || !prefilter("normal", normal))) return {};

  Filter filter(m_oidn, m_device, margin);
  filter.image("color", color);
  filter.image("albedo", albedo);
  filter.image("normal", normal);
  filter.image("output", color);
  filter.flag("hdr", true);
  filter.flag("cleanAux", prefiltered || (auxiliaries == Auxiliaries::clean && usesBoth(input)));
  if (!run(filter)) return {};
  progress.end();
  color = margin.remove(std::move(color));
  range.restore(color);
  return color;
}

std::string auxiliariesText(const DenoiserInput& input, Auxiliaries auxiliaries) {
  if (auxiliaries == Auxiliaries::none || input.albedo.empty()) return "none";
  if (input.normal.empty()) return "albedo";
  const std::string both = "albedo and normal";
  if (auxiliaries == Auxiliaries::clean) return both + ", clean";
  return auxiliaries == Auxiliaries::prefiltered ? both + ", prefiltered" : both;
}

}  // namespace odis::render
