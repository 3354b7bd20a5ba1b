// What the handles of the C interface point to.
#pragma once

#include <atomic>
#include <cstdint>

namespace odis::core {

// An object with a count of references.
class Object {
 public:
  virtual ~Object() = default;
  void retain() { m_references.fetch_add(1, std::memory_order_relaxed); }
  void release() {
    if (m_references.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
  }

 private:
  std::atomic<uint32_t> m_references{1};
};

}  // namespace odis::core
