// The program's own allocation functions (firmware-host/allocation.cpp), which are linked into this test.
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/threads/hot_path.h"

namespace octascope {
namespace {

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};
using Memory = std::unique_ptr<void, Free>;

// What the kernel notes of the mapping that holds this byte (proc(5)): "hg" where large pages were asked for.
std::string flags_of(const void* byte) {
  const auto wanted = reinterpret_cast<std::uintptr_t>(byte);
  std::ifstream maps{"/proc/self/smaps"};
  bool here = false;
  for (std::string line; std::getline(maps, line);) {
    const std::size_t dash = line.find('-');
    const std::size_t colon = line.find(':');
    if (dash < colon) { // "begin-end …": the next mapping
      const auto number = [&](std::size_t at) { return std::strtoull(&line[at], nullptr, 16); };
      here = number(0) <= wanted && wanted < number(dash + 1);
    } else if (here && line.starts_with("VmFlags:")) {
      return line + " ";
    }
  }
  return {};
}

TEST(Allocation, WhatIsLargeLiesOnLargePages) {
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage"))
    GTEST_SKIP() << "this kernel has no transparent huge pages";
  constexpr std::size_t large = std::size_t{12} << 20U;
  const auto asks = [](const void* memory) {
    return flags_of(static_cast<const std::uint8_t*>(memory) + large / 2).find(" hg ") !=
           std::string::npos;
  };
  const std::vector<std::uint8_t> volume(large);
  EXPECT_TRUE(asks(volume.data()));
  const Memory cleared{std::calloc(large / 4, 4)};
  EXPECT_TRUE(asks(cleared.get()));
  const Memory aligned{std::aligned_alloc(64, large)};
  EXPECT_TRUE(asks(aligned.get()));
  Memory grown{std::malloc(large / 8)};
  grown.reset(std::realloc(grown.release(), large));
  EXPECT_TRUE(asks(grown.get()));
  const Memory small{std::malloc(1000)};
  EXPECT_EQ(flags_of(small.get()).find(" hg "), std::string::npos);
}

TEST(Allocation, RefusesAlignmentsAsTheStandardSays) {
  void* memory = this;
  for (const std::size_t alignment : {0U, 1U, 4U, 24U})
    EXPECT_EQ(posix_memalign(&memory, alignment, 100), EINVAL) << alignment;
  EXPECT_EQ(memory, this);
  EXPECT_EQ(posix_memalign(&memory, 64, SIZE_MAX / 2), ENOMEM);
  EXPECT_EQ(memory, this);
  ASSERT_EQ(posix_memalign(&memory, 4096, 100), 0);
  const Memory owned{memory};
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % 4096, 0U);
}

TEST(Allocation, IsCountedOnHotPathsAlone) {
  const std::uint64_t before = pipeline::HotPath::allocations();
  const Memory elsewhere{std::malloc(100)};
  EXPECT_EQ(pipeline::HotPath::allocations(), before);
  void* aligned = nullptr;
  {
    const pipeline::HotPath hot;
    const Memory made{std::malloc(100)};
    const Memory cleared{std::calloc(10, 10)};
    EXPECT_EQ(posix_memalign(&aligned, 64, 100), 0);
  }
  const Memory owned{aligned};
  EXPECT_EQ(pipeline::HotPath::allocations(), before + 3);
}

} // namespace
} // namespace octascope
