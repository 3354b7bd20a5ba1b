// How far work has come, told to a host that may call it off.
#pragma once

#include <exception>

#include "odis/structs.h"

namespace odis::core {

class Cancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled by the progress function"; }
};

class Progress {
 public:
  Progress() = default;
  Progress(OdisProgressFunction function, void* user) : m_function(function), m_user(user) {}

  // Throws Cancelled where the host does not want to go on.
  void report(double fraction) const {
    if (m_function && !m_function(m_user, fraction)) throw Cancelled();
  }

 private:
  OdisProgressFunction m_function = nullptr;
  void* m_user = nullptr;
};

}  // namespace odis::core
