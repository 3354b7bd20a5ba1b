// A host of Open PGL's that knows nothing of ODIS: it learns from some samples and draws a direction.
#include <openpgl/cpp/OpenPGL.h>

#include <cstdio>
#include <cstring>

int main() {
  openpgl::cpp::Device device(PGL_DEVICE_TYPE_CPU_4);
  openpgl::cpp::FieldConfig config;
  config.Init(PGL_SPATIAL_STRUCTURE_KDTREE, PGL_DIRECTIONAL_DISTRIBUTION_PARALLAX_AWARE_VMM);
  openpgl::cpp::Field field(&device, config);
  openpgl::cpp::SampleStorage samples;
  for (int i = 0; i < 1000; ++i)
    samples.AddSample({{float(i % 10), float(i / 10 % 10), 0}, {0.6f, 0, 0.8f}, 5, 0.25f, 3, 0});
  // What lies beside a flag in memory is no flag.
  openpgl::cpp::ZeroValueSampleData zero;
  std::memset(static_cast<void*>(&zero), 0xfe, sizeof zero);
  zero = {{1, 2, 0}, {0, 0.6f, 0.8f}, false};
  samples.AddZeroValueSample(zero);
  const bool taken = samples.GetSizeSurface() == 1001;
  field.Update(samples);
  std::printf("%zu update, version %d.%d\n", field.GetIteration(), OPENPGL_VERSION_MAJOR,
              OPENPGL_VERSION_MINOR);
  return taken && field.GetIteration() == 1 ? 0 : 1;
}
