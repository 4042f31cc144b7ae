// Functions of the C library that a program defines itself are called in place of the library's,
// by its shared libraries too.
#include "tests/engine/call_counts.h"

#ifdef STAGGER_CALLS_ARE_COUNTED

#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>
#include <cstdlib>
#include <typeinfo>

namespace {

stagger::testing::CallCounts counts;

template <typename Function>
Function* next_of(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

// glibc's own names of these: dlsym() itself may ask for memory.
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t number, std::size_t size) noexcept;
void* __libc_realloc(void* memory, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;
void __libc_free(void* memory) noexcept;

void* malloc(std::size_t size) noexcept {
  ++counts.allocations;
  return __libc_malloc(size);
}

void* calloc(std::size_t number, std::size_t size) noexcept {
  ++counts.allocations;
  return __libc_calloc(number, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  ++counts.allocations;
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++counts.allocations;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++counts.allocations;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  ++counts.allocations;
  void* const got = __libc_memalign(alignment, size);
  if (got == nullptr) return ENOMEM;
  *memory = got;
  return 0;
}

void free(void* memory) noexcept {
  if (memory != nullptr) ++counts.frees;
  __libc_free(memory);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static const auto lock = next_of<int(pthread_mutex_t*)>("pthread_mutex_lock");
  ++counts.locks;
  return lock(mutex);
}

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*destroy)(void*)) {
  ++counts.throws;
  next_of<void(void*, std::type_info*, void (*)(void*))>("__cxa_throw")(thrown, type, destroy);
  std::abort();  // it does not come back
}

}  // extern "C"

namespace stagger::testing {

CallCounts call_counts() { return counts; }

}  // namespace stagger::testing

#else

namespace stagger::testing {

CallCounts call_counts() { return {}; }

}  // namespace stagger::testing

#endif
