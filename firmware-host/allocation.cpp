// The program's allocation functions: the C library's, with one question before each: is this
// thread on a hot path? The count goes into the report ("hot_path.allocations") and must be 0.
//
// What is large (volumes, textures) is put on pages of 2 MiB where the kernel grants them to those who
// ask: 12 MB are 6 page faults instead of 3000, and what walks through them misses the TLB less.
//
// The C functions are replaced, not operator new alone, so that libraries written in C count too.
// A sanitizer brings allocation functions of its own, and asks a hook.
#include <cerrno>
#include <cstddef>
#include <cstdint>

#include <sys/mman.h>
#include <unistd.h>

#include "pipeline/threads/hot_path.h"

using octascope::pipeline::HotPath;

#ifndef OCTASCOPE_SANITIZED

namespace {

// Advice: all works without it.
void* on_large_pages(void* memory, std::size_t size) {
  constexpr std::size_t large = std::size_t{4} << 20U;
  if (size < large || memory == nullptr)
    return memory;
  const auto page = static_cast<std::uintptr_t>(getpagesize());
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) & ~(page - 1);
  const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(memory) + size;
  const int error_of_others = errno;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  errno = error_of_others;
  return memory;
}

} // namespace

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  HotPath::count_allocation();
  return on_large_pages(__libc_malloc(size), size);
}

void* calloc(std::size_t count, std::size_t size) {
  HotPath::count_allocation();
  return on_large_pages(__libc_calloc(count, size), count * size);
}

void* realloc(void* old, std::size_t size) {
  HotPath::count_allocation();
  return on_large_pages(__libc_realloc(old, size), size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  HotPath::count_allocation();
  return on_large_pages(__libc_memalign(alignment, size), size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  const bool is_power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!is_power_of_two || alignment % sizeof(void*) != 0)
    return EINVAL;
  void* const made = aligned_alloc(alignment, size);
  if (made == nullptr)
    return ENOMEM;
  *memory = made;
  return 0;
}

} // extern "C"

#else

// Called by the sanitizer's own allocator after every allocation, C or C++.
extern "C" void __sanitizer_malloc_hook(const volatile void* memory, std::size_t size);

extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t) {
  HotPath::count_allocation();
}

#endif
