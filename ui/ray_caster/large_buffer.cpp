#include "ui/ray_caster/large_buffer.h"

#include <new>

#include <sys/mman.h>

namespace octascope::ui {

namespace {
constexpr std::size_t large_page = std::size_t{2} << 20U;
}

LargeBuffer::LargeBuffer(std::size_t size) {
  // Whole large pages: the kernel aligns mappings of that size to them, and a part of one would
  // stay on small pages.
  const std::size_t whole = (size + large_page - 1) / large_page * large_page;
  void* mapped = mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED)
    throw std::bad_alloc{};
  madvise(mapped, whole, MADV_HUGEPAGE); // advice: all works without it
  bytes_ = {static_cast<std::uint8_t*>(mapped), Unmap{whole}};
}

void LargeBuffer::Unmap::operator()(std::uint8_t* bytes) const {
  munmap(bytes, size);
}

} // namespace octascope::ui
