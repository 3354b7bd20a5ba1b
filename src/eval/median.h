// The middle of several measurements: their median and their mean.
#pragma once

#include <algorithm>
#include <vector>

namespace odis::eval {

// The mean of the two in the middle if their number is even; 0 if there are none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

// 0 if there are none.
inline double mean(std::vector<double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / double(values.size());
}

}  // namespace odis::eval
