// A host of Open PGL 0.8: its flags of samples, and its image-space guiding buffer with a configuration.
#include <openpgl/cpp/OpenPGL.h>

#include <cstdio>

#if OPENPGL_VERSION_MINOR != 8 || !defined(OPENPGL_IMAGE_SPACE_GUIDING_BUFFER)
#error "expected the interface of version 0.8"
#endif

namespace {

int failures = 0;
void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("expected %s\n", what);
  ++failures;
}

// Only samples that are inside of volumes themselves are left out.
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
  expect(samples.GetSizeSurface() == 2, "samples in volumes to be left out");
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

}  // namespace

int main() {
  trySamples();
  tryImage();
  std::printf("%d failures\n", failures);
  return failures;
}
