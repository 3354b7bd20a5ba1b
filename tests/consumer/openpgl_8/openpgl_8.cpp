// A host of Open PGL 0.8: its flags of samples, and its image-space guiding buffer with a configuration.
#include <openpgl/cpp/OpenPGL.h>

#include <cmath>
#include <cstdio>
#include <utility>

#if OPENPGL_VERSION_MINOR != 8 || !defined(OPENPGL_IMAGE_SPACE_GUIDING_BUFFER) || \
    !defined(OPENPGL_VSP_GUIDING)
#error "expected the interface of version 0.8"
#endif

namespace {

int failures = 0;
void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("expected %s\n", what);
  ++failures;
}

// Only samples that are inside of volumes themselves are those of volumes.
void trySamples() {
  openpgl::cpp::SampleStorage samples;
  openpgl::cpp::ZeroValueSampleData zero{{1, 2, 3}, {0, 0, 1}, PGLSampleData::ENextEventVolume};
  samples.AddZeroValueSample(zero);
  openpgl::cpp::SampleData sample{{1, 2, 3}, {0, 0, 1}, 5, 0.25f, 3, PGLSampleData::ENextEventVolume};
  samples.AddSample(sample);
  expect(samples.GetSizeSurface() == 2, "samples before volumes to be taken");
  zero.flags |= PGLSampleData::EInsideVolume;
  sample.flags |= PGLSampleData::EInsideVolume;
  samples.AddZeroValueSample(zero);
  samples.AddSample(sample);
  expect(samples.GetSizeSurface() == 2 && samples.GetSizeVolume() == 2,
         "samples in volumes to be told apart");
}

void tryImage() {
  using Buffer = openpgl::cpp::util::ImageSpaceGuidingBuffer;
  Buffer::Config config({64, 32});
  config.EnableContributionEstimate(true);
  config.SetContributionType(EContribContribution);
  expect(config.GetResolution().x == 64 && config.ContributionEstimate(), "the configuration to be kept");
  Buffer buffer(config);
  expect(!buffer.IsReady(), "nothing to be known before an update");
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      Buffer::Sample sample;
      const float value = x < 32 ? 1.0f : 9.0f;
      sample.contribution = {value, value, value};
      sample.SetSurfaceEvent(true);
      expect(sample.IsSurfaceEvent(), "a surface");
      buffer.AddSample({x, y}, sample);
    }
  buffer.AddSample({64, 0}, Buffer::Sample());  // outside
  buffer.Update();
  expect(buffer.IsReady(), "estimates after an update");
  // A tenth of the image's mean, 5, comes on top.
  const float dark = buffer.GetContributionEstimate({3, 3}).y;
  const float bright = buffer.GetContributionEstimate({60, 9}).y;
  expect(dark > 1.49f && dark < 1.51f, "the mean of the dark side");
  expect(bright > 9.49f && bright < 9.51f, "the mean of the bright side");
  expect(buffer.GetContributionEstimate({0, 32}).x == 0, "nothing outside");
  buffer.Reset();
  expect(!buffer.IsReady(), "nothing after a reset");
}

bool isNear(float a, float b) {
  return a > b - 1e-5f && a < b + 1e-5f;
}

// A volume on the left half of an image: one of four samples meets it there, and brings three times
// as much as a surface does. Returns the estimates of the left and of the right half.
std::pair<float, float> scatterProbabilities(PGLVSPTypes type) {
  using Buffer = openpgl::cpp::util::ImageSpaceGuidingBuffer;
  Buffer::Config config({64, 32});
  config.EnableVolumeScatterProbabilityEstimate(true);
  config.SetVolumeScatterProbabilityType(type);
  Buffer buffer(config);
  expect(buffer.GetVolumeScatterProbabilityEstimate({3, 3}) == 0.5f, "one half before an update");
  buffer.Update();
  expect(buffer.GetVolumeScatterProbabilityEstimate({3, 3}) == -1, "nothing of nothing");
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      for (int i = 0; i < 4; ++i) {
        Buffer::Sample sample;
        const bool inVolume = i == 0 && x < 32;
        const float value = inVolume ? 3.0f : 1.0f;
        sample.contribution = {value, value, value};
        sample.SetSurfaceEvent(!inVolume);
        buffer.AddSample({x, y}, sample);
      }
  buffer.Update();
  return {buffer.GetVolumeScatterProbabilityEstimate({3, 3}),
          buffer.GetVolumeScatterProbabilityEstimate({60, 9})};
}

void tryVolumes() {
  // Means, with a tenth of the image's, which brings 3 / 8 in volumes and 7 / 8 on surfaces.
  const auto [left, right] = scatterProbabilities(EVSPContribution);
  expect(isNear(left, (3 / 4.0f + 3 / 80.0f) / (3 / 2.0f + 10 / 80.0f)), "the share of what volumes bring");
  expect(isNear(right, (3 / 80.0f) / (1 + 10 / 80.0f)), "a tenth of the image's share");
  // Second moments: 9 of a quarter and 1 of three quarters, in the image of an eighth and of seven.
  const auto [deviation, rest] = scatterProbabilities(EVSPVariance);
  const float volume = std::sqrt((1 / 4.0f + 1 / 80.0f) * 9 * (1 / 4.0f + 1 / 80.0f)),
              surface = 3 / 4.0f + 7 / 80.0f;
  expect(isNear(deviation, volume / (volume + surface)), "the share of deviations");
  expect(isNear(rest, (3 / 80.0f) / (3 / 80.0f + 1 + 7 / 80.0f)), "a tenth of the image's deviation");
  openpgl::cpp::util::ImageSpaceGuidingBuffer unasked(
      openpgl::cpp::util::ImageSpaceGuidingBuffer::Config({8, 8}));
  unasked.Update();
  expect(unasked.GetVolumeScatterProbabilityEstimate({3, 3}) == 0.5f, "one half where it was not asked for");
}

}  // namespace

int main() {
  trySamples();
  tryImage();
  tryVolumes();
  std::printf("%d failures\n", failures);
  return failures;
}
