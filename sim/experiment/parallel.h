// The same pure function on many inputs, on all cores; results in the order of the inputs.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <type_traits>
#include <vector>

namespace stagger::sim {

/// One result for each input, the same whatever the number of threads. The first exception of
/// `function` is thrown again here.
template <typename Input, typename Function>
auto parallel_map(const std::vector<Input>& inputs, const Function& function,
                  unsigned threads = std::thread::hardware_concurrency()) {
  using Result = std::decay_t<decltype(function(inputs.front()))>;
  static_assert(!std::is_same_v<Result, bool>, "bits of one byte cannot be written by two threads");
  std::vector<Result> results(inputs.size());
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < inputs.size() && !failed; i = next++) {
      try {
        results[i] = function(inputs[i]);
      } catch (...) {
        if (!failed.exchange(true)) failure = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> team;
    const std::size_t most = std::min<std::size_t>(std::max(threads, 1U), inputs.size());
    for (std::size_t i = 1; i < most; ++i) team.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  return results;
}

}  // namespace stagger::sim
