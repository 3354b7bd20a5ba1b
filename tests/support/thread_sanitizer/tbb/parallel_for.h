// Stands in for TBB's header in builds with the thread sanitizer. The sanitizer doesn't see how the library,
// which is not built with it, hands work from thread to thread, and would call every such work a race. Here
// it is handed over by std::thread, which the sanitizer knows; the ranges and what is done with them are the
// same.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace tbb {

template <class Range, class Body, class... Partitioner>
requires(!std::is_integral_v<Range>) void parallel_for(const Range& whole, const Body& body,
                                                       Partitioner&&...) {
  std::vector<Range> pieces{whole};
  for (size_t i = 0; i < pieces.size();)
    if (pieces[i].is_divisible())
      pieces.push_back(Range(pieces[i], split()));
    else
      ++i;
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    try {
      for (size_t i; (i = next++) < pieces.size();)
        if (!pieces[i].empty()) body(pieces[i]);
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

template <class Index, class Function>
void parallel_for(Index first, Index last, const Function& function) {
  const Index grain = std::max(Index((last - first) / 16), Index(1));
  parallel_for(blocked_range<Index>(first, last, grain), [&](const blocked_range<Index>& range) {
    for (Index i = range.begin(); i != range.end(); ++i) function(i);
  });
}

}  // namespace tbb
