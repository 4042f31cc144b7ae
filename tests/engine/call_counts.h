// Counts what a controller may not do on its tick: take memory or give it back, throw, lock.
#pragma once

#include <cstddef>

// The sanitizers bring an allocator and an unwinder of their own.
#ifndef STAGGER_SANITIZED
#define STAGGER_CALLS_ARE_COUNTED
#endif

namespace stagger::testing {

struct CallCounts {
  std::size_t allocations = 0;  ///< every kind of new ends in malloc or one of its siblings
  std::size_t frees = 0;        ///< of something; free(nullptr) does nothing
  std::size_t throws = 0;
  std::size_t locks = 0;  ///< of a POSIX mutex, which std::mutex is

  bool operator==(const CallCounts&) const = default;
};

/// Of the whole program, standard library included, since it began. Not for several threads.
CallCounts call_counts();

}  // namespace stagger::testing
