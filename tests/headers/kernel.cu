// A kernel that does at a vertex all that a guide decides, from the same headers as the CPU. It is
// compiled, not run.
#include <odis/guide_view.h>
#include <odis/mixture.h>

namespace {

// A diffuse BSDF as odis::Mixture asks for it.
struct DiffuseHost {
  struct Sample {
    odis::Float3 wi;
    float pdf, weight;
  };
  odis::Float3 normal;

  __device__ float density(const odis::Float3& wi) const {
    return fmaxf(odis::dot(wi, normal), 0) / 3.14159265f;
  }
  __device__ Sample sampleBsdf(float, float) const { return {normal, density(normal), 1}; }
  __device__ bool isDiscrete(const Sample&) const { return false; }
  __device__ bool isSharp(const Sample&) const { return false; }
  __device__ bool failed(const Sample& sample) const { return !(sample.weight > 0); }
  template <class PdfOf>
  __device__ Sample evaluate(const odis::Float3& wi, const PdfOf& pdfOf) const {
    const float bsdf = density(wi), pdf = pdfOf(bsdf, bsdf);
    return {wi, pdf, bsdf / pdf};
  }
  template <class PdfOf>
  __device__ void reweigh(Sample& sample, const PdfOf& pdfOf) const {
    const float pdf = pdfOf(sample.pdf, sample.pdf, sample.wi);
    sample.weight *= sample.pdf / pdf;
    sample.pdf = pdf;
  }
};

__global__ void scatter(odis::GuideView view, const odis::Place* places, float* results) {
  const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
  const uint32_t cell = odis::findCell(view, places[i]);
  if (cell == odis::kNoCell) return;
  const odis::CellDecisions& decisions = view.decisions[cell];
  results[i] = odis::survivalProbability(view.rules, decisions.survivalFactor, 1.0f) +
               odis::shadowRayProbability(view.rules, 0.01f) + odis::learnedLights(view, cell).fraction;
  odis::VertexMap<float> map;
  map.prepare(view.maps, int32_t(cell), places[i].normal, 0.0f);
  const odis::Mixture<float> mixture(odis::bsdfFraction(view, int32_t(cell), 1.0f), 1.0f);
  results[i] += mixture.sample(map, 0.3f, 0.7f, DiffuseHost{places[i].normal}).weight;
}

}  // namespace

int main() {
  scatter<<<1, 1>>>({}, nullptr, nullptr);
}
