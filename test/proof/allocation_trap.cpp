// Replaces malloc, free and the related functions in the whole program.
#include "test/proof/allocation_trap.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <unistd.h>

extern "C" {
void* __libc_malloc(std::size_t) noexcept;
void* __libc_calloc(std::size_t, std::size_t) noexcept;
void* __libc_realloc(void*, std::size_t) noexcept;
void* __libc_memalign(std::size_t, std::size_t) noexcept;
void __libc_free(void*) noexcept;
}

namespace takt::proof {
namespace {

thread_local bool trapped = false;
thread_local bool counted = false;
thread_local std::uint64_t count = 0;

void note(const char* what) noexcept {
  if (counted) ++count;
  if (!trapped) return;
  static constexpr char text[] = "trapped on the bus thread: ";
  [[maybe_unused]] ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
  written = write(STDERR_FILENO, what, std::strlen(what));
  written = write(STDERR_FILENO, "\n", 1);
  _exit(allocation_exit);
}

}  // namespace

void trap_allocations(bool on) noexcept { trapped = on; }
void count_allocations(bool on) noexcept { counted = on; }
std::uint64_t allocations() noexcept { return count; }

}  // namespace takt::proof

// operator new and delete of libstdc++ end here as well.
extern "C" {

void* malloc(std::size_t size) noexcept {
  takt::proof::note("malloc");
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  takt::proof::note("calloc");
  return __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) noexcept {
  takt::proof::note("realloc");
  return __libc_realloc(old, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  takt::proof::note("memalign");
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  takt::proof::note("aligned_alloc");
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** result, std::size_t alignment, std::size_t size) noexcept {
  takt::proof::note("posix_memalign");
  *result = __libc_memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}

void free(void* block) noexcept {
  if (block != nullptr) takt::proof::note("free");
  __libc_free(block);
}

}  // extern "C"
