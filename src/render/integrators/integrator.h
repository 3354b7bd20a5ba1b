// The interface of integrators: each renders an image its own way, on the same path tracer.
#pragma once

#include <memory>

#include "render/integrators/job.h"

namespace odis::render {

class Integrator {
 public:
  virtual ~Integrator() = default;

  // Takes all samples of all pixels.
  virtual void render() = 0;
  // Does everything that comes before a sample of a pixel, and returns the pass that it is traced in.
  // Instead of render(), once. Throws OptionError where samples are not traced one by one.
  virtual Pass passBefore(uint32_t pixel, uint32_t sample) = 0;
  // Whether samples are guided by what a pilot saw, so that there are features of the guide.
  virtual bool hasPilot() const { return false; }
  // Fills in the image's colour, its variance if that is asked for, and what depends on the integrator of
  // features and statistics.
  virtual void finish(RenderResult& result) = 0;
};

// Each integrator works on the job as long as it lives.
std::unique_ptr<Integrator> makePathIntegrator(RenderJob& job);
std::unique_ptr<Integrator> makeOdisIntegrator(RenderJob& job);
std::unique_ptr<Integrator> makePpgIntegrator(RenderJob& job);
std::unique_ptr<Integrator> makeOpenPglIntegrator(RenderJob& job);
std::unique_ptr<Integrator> makeRestirIntegrator(RenderJob& job);

// The integrator that the job's options name.
std::unique_ptr<Integrator> makeIntegrator(RenderJob& job);

// The mean of a pixel, and of how many samples it is.
struct MeanOfSamples {
  PixelMean mean;
  uint32_t samples = 0;
};
// The mean of all samples of some parts.
MeanOfSamples meanOfParts(ArrayView<const WeightedSums> parts);

// Sets the image's pixels, and their variance, by the sums of a film that splats (colorChannels). With W0 and
// W1 the sums of weights of the halves of the samples, and I0 and I1 their images, the variance of the mean
// is estimated as (I0 - I1)^2 W0 W1 / (W0 + W1)^2: as if the variance of an image fell with its weight.
void fillPixels(RenderResult& result, std::span<const float> sums, int channels);
void fillPixels(RenderResult& result, const SplatFilm& film);
// Sets the pixels of an image from the mean of each.
void fillPixels(RenderResult& result, const RenderOptions& options,
                const std::function<MeanOfSamples(uint32_t pixel)>& mean);

}  // namespace odis::render
