// The mean of random numbers, and how well it is known.
#pragma once

#include <cmath>

namespace odis::test {

class Average {
 public:
  void add(double value) {
    m_sum += value;
    m_squares += value * value;
    m_count += 1;
  }
  double count() const { return m_count; }
  double mean() const { return m_sum / m_count; }
  double standardError() const { return std::sqrt((m_squares / m_count - mean() * mean()) / m_count); }

 private:
  double m_sum = 0, m_squares = 0, m_count = 0;
};

}  // namespace odis::test
