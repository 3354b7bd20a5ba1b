// Shrinkage: what few samples say is drawn towards what is known from elsewhere, whose weight is counted in
// samples.
#pragma once

namespace odis::core {

// The mean of samples whose sum and number are given, shrunk towards `prior` as if that were the mean of
// `priorSamples` more.
inline double shrunkMean(double sum, double samples, double prior, double priorSamples) {
  return (sum + priorSamples * prior) / (samples + priorSamples);
}

// The weight in [0, 1) that samples have beside `priorSamples` > 0 others.
inline double ownWeight(double samples, double priorSamples) {
  return samples / (samples + priorSamples);
}

// The number of samples of equal size that a sum and a sum of squares could be of: many samples of which
// one holds everything are but one.
inline double effectiveSamples(double sum, double squares) {
  return squares > 0 ? sum * sum / squares : 0;
}

}  // namespace odis::core
