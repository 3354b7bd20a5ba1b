// Adam (Kingma and Ba 2015), for one variable, one gradient a step.
#pragma once

#include <algorithm>
#include <cmath>

namespace odis::render {

class Adam {
 public:
  // The variable stays within [-bound, bound].
  void step(float gradient, float learningRate, float bound) {
    constexpr float kFirst = 0.9f, kSecond = 0.999f, kEpsilon = 1e-8f;
    m_firstPower *= kFirst;
    m_secondPower *= kSecond;
    m_first = kFirst * m_first + (1 - kFirst) * gradient;
    m_second = kSecond * m_second + (1 - kSecond) * gradient * gradient;
    const float rate = learningRate * std::sqrt(1 - m_secondPower) / (1 - m_firstPower);
    m_value = std::clamp(m_value - rate * m_first / (std::sqrt(m_second) + kEpsilon), -bound, bound);
  }
  float value() const { return m_value; }

 private:
  float m_value = 0, m_first = 0, m_second = 0;
  float m_firstPower = 1, m_secondPower = 1;  // beta^steps
};

}  // namespace odis::render
