// A guide on a GPU: a kernel that asks at many vertices for all that the guide decides, by the same headers as
// on the CPU, and comes to the same. docs/gpu.md tells of the arrays. Where there is no GPU the program says so
// and ends with 77.
//
//   nvcc -std=c++17 lookups.cu -lodis -o lookups
#include <odis/odis.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace {

// A diffuse BSDF as odis::Mixture asks for it.
struct DiffuseHost {
  struct Sample {
    odis::Float3 wi;
    float pdf, weight;
  };
  odis::Float3 normal;

  ODIS_HOST_DEVICE float density(const odis::Float3& wi) const {
    return fmaxf(odis::dot(wi, normal), 0) / 3.14159265f;
  }
  ODIS_HOST_DEVICE Sample sampleBsdf(float, float) const { return {normal, density(normal), 1}; }
  ODIS_HOST_DEVICE bool isDiscrete(const Sample&) const { return false; }
  ODIS_HOST_DEVICE bool isSharp(const Sample&) const { return false; }
  ODIS_HOST_DEVICE bool failed(const Sample& sample) const { return !(sample.weight > 0); }
  template <class PdfOf>
  ODIS_HOST_DEVICE Sample evaluate(const odis::Float3& wi, const PdfOf& pdfOf) const {
    const float bsdf = density(wi), pdf = pdfOf(bsdf, bsdf);
    return {wi, pdf, bsdf / pdf};
  }
  template <class PdfOf>
  ODIS_HOST_DEVICE void reweigh(Sample& sample, const PdfOf& pdfOf) const {
    const float pdf = pdfOf(sample.pdf, sample.pdf, sample.wi);
    sample.weight *= sample.pdf / pdf;
    sample.pdf = pdf;
  }
};

// What a path would be told at a place, and what it would draw; 0 where nothing is known.
ODIS_HOST_DEVICE float scatterAt(const odis::GuideView& view, const odis::Place& place, float u, float v) {
  odis::GuidedVertex vertex(view, place, 1);
  if (!vertex.isKnown()) return 0;
  float result = vertex.survivalProbability(1, 1) + vertex.shadowRayProbability(0.01f) +
                 vertex.lightProbability(0, 0.5f);
  vertex.prepare(1);
  return result + vertex.sample(u, v, DiffuseHost{place.normal}).weight;
}

__global__ void scatter(odis::GuideView view, const odis::Place* places, const float2* numbers,
                        uint32_t count, float* results) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < count) results[i] = scatterAt(view, places[i], numbers[i].x, numbers[i].y);
}

void require(cudaError_t error) {
  if (error == cudaSuccess) return;
  std::fprintf(stderr, "CUDA: %s\n", cudaGetErrorString(error));
  std::exit(1);
}

// A copy of an array in the memory of the GPU, which is freed when the program ends.
template <class T>
T* onDevice(const T* host, size_t count) {
  T* device = nullptr;
  require(cudaMalloc(&device, count * sizeof(T)));
  if (host) require(cudaMemcpy(device, host, count * sizeof(T), cudaMemcpyHostToDevice));
  return device;
}

odis::GuideView onDevice(odis::GuideView view) {
  const size_t cells = view.cellCount;
  view.slots = onDevice(view.slots, view.slotMask + 1);
  view.keys = onDevice(view.keys, cells);
  view.maps = onDevice(view.maps, cells * odis::kMapShares);
  view.decisions = onDevice(view.decisions, cells);
  view.lightTables = onDevice(view.lightTables, cells * (view.lightGroups + 1));
  return view;
}

// A floor of 1 x 1 that bright light falls on from one side.
std::vector<odis::PathVertex> litFloor(uint32_t count) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<odis::PathVertex> vertices(count);
  for (odis::PathVertex& v : vertices) {
    v.position = {uniform(engine), uniform(engine), 0};
    v.normal = {0, 0, 1};
    const float r = std::sqrt(uniform(engine)), phi = 6.2831853f * uniform(engine);
    v.wi = {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::fmax(0.0f, 1 - r * r))};
    v.pdf = v.wi.z / 3.14159265f;
    const float radiance = v.wi.x > 0.7f ? 50.0f : 0.1f;
    v.radiance = {radiance, radiance, radiance};
    v.depth = 1;
  }
  return vertices;
}

}  // namespace

int main() {
  const std::vector<odis::PathVertex> vertices = litFloor(50000);
  odis::GuideOptions options;
  options.set("bsdf-fraction=0.4");
  odis::GuideBuilder builder(options);
  builder.add(vertices);
  const odis::Guide guide = builder.build();
  const odis::GuideView view = guide.view();
  std::vector<odis::Place> places;
  std::vector<float2> numbers;
  std::vector<float> expected;
  for (size_t i = 0; i < vertices.size(); ++i) {
    places.push_back({vertices[i].position, vertices[i].normal, uint32_t(i), 0, false, 2});
    numbers.push_back({float(i * 7919 % 1000) / 1000, float(i * 104729 % 997) / 997});
    expected.push_back(scatterAt(view, places[i], numbers[i].x, numbers[i].y));
  }
  if (std::count(expected.begin(), expected.end(), 0.0f) > 0) {
    std::fprintf(stderr, "the guide knows nothing of some places\n");
    return 1;
  }
  int devices = 0;
  if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
    std::printf("there is no GPU: the kernel was compiled, not run\n");
    return 77;
  }
  const auto count = uint32_t(places.size());
  float* results = onDevice<float>(nullptr, count);
  scatter<<<(count + 127) / 128, 128>>>(onDevice(view), onDevice(places.data(), count),
                                        onDevice(numbers.data(), count), count, results);
  std::vector<float> found(count);
  require(cudaMemcpy(found.data(), results, count * sizeof(float), cudaMemcpyDeviceToHost));
  // A GPU rounds otherwise now and then, and a number between two texels then falls into the other one.
  uint32_t differ = 0;
  for (uint32_t i = 0; i < count; ++i)
    differ += !(std::fabs(found[i] - expected[i]) <= 1e-3f * (1 + std::fabs(expected[i])));
  std::printf("%u of %u places differ\n", differ, count);
  return differ <= count / 1000 ? 0 : 1;
}
