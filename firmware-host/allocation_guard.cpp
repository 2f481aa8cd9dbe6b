// The program's allocation functions: the C library's, with one question before each: is this
// thread on a hot path? The count goes into the report ("hot_path.allocations") and must be 0.
//
// The C functions are replaced, not operator new alone, so that libraries written in C count too.
// A sanitizer brings allocation functions of its own, and asks a hook.
#include <cstddef>

#include "pipeline/threads/hot_path.h"

using octascope::pipeline::HotPath;

#ifndef OCTASCOPE_SANITIZED

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  HotPath::count_allocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  HotPath::count_allocation();
  return __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) {
  HotPath::count_allocation();
  return __libc_realloc(old, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  HotPath::count_allocation();
  return __libc_memalign(alignment, size);
}

} // extern "C"

#else

// Called by the sanitizer's own allocator after every allocation, C or C++.
extern "C" void __sanitizer_malloc_hook(const volatile void* memory, std::size_t size);

extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t) {
  HotPath::count_allocation();
}

#endif
