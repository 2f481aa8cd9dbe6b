#include <algorithm>
#include <cstring>
#include <random>

#include <gtest/gtest.h>
#include <sys/mman.h>

#include "hal/linux/libcamera/mapped_picture.h"
#include "hal/linux/libcamera/plane_plan.h"
#include "hal/linux/system/file_descriptor.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::tests {
namespace {

namespace backend = hal::linux_backend;
using backend::BufferPlane;
using backend::Encoding;
using backend::PictureLayout;

constexpr PictureLayout nv12{Encoding::nv12, {6, 4}, 8}; // 32 bytes luma, 14 of 16 chroma
constexpr PictureLayout yuyv{Encoding::yuyv, {6, 4}, 16};

TEST(PlanePlan, planes_that_adjoin_are_one_piece) {
  const auto plan = backend::plan_planes({{7, 64, 32}, {7, 96, 16}}, nv12);
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->files.size(), 1U);
  EXPECT_EQ(plan->files[0].length, 112U);
  ASSERT_EQ(plan->pieces.size(), 1U);
  EXPECT_EQ(plan->pieces[0].offset, 64U);
  EXPECT_EQ(plan->pieces[0].length, nv12.bytes());
}

TEST(PlanePlan, planes_apart_are_two_pieces) {
  for (const auto& planes : {std::vector<BufferPlane>{{7, 0, 32}, {8, 0, 16}},
                             std::vector<BufferPlane>{{7, 0, 32}, {7, 4096, 16}}}) {
    const auto plan = backend::plan_planes(planes, nv12);
    ASSERT_TRUE(plan) << plan.error().message;
    ASSERT_EQ(plan->pieces.size(), 2U);
    EXPECT_EQ(plan->pieces[0].place, 0U);
    EXPECT_EQ(plan->pieces[1].place, 32U);
    EXPECT_EQ(plan->pieces[1].place + plan->pieces[1].length, nv12.bytes());
  }
}

TEST(PlanePlan, a_plane_that_is_too_short_is_refused_with_both_sizes) {
  const auto plan = backend::plan_planes({{7, 0, 62}}, {Encoding::yuyv, {6, 4}, 17});
  ASSERT_THAT(plan, FailsWith(hal::ErrorCode::bad_data, "62 bytes"));
  EXPECT_FALSE(backend::plan_planes({{7, 0, 32}, {8, 0, 13}}, nv12)) << "chroma";
  EXPECT_FALSE(backend::plan_planes({}, yuyv));
  EXPECT_FALSE(backend::plan_planes({{-1, 0, 100}}, yuyv));
  EXPECT_FALSE(backend::plan_planes({{7, 0, 100}}, {Encoding::yuyv, {6, 4}, 11})) << "rows overlap";
  EXPECT_FALSE(backend::plan_planes({{7, 0, 100}}, {Encoding::yuyv, {0, 4}, 16}));
}

TEST(PlanePlan, of_a_jpeg_is_the_whole_buffer) {
  const auto plan = backend::plan_planes({{7, 0, 5000}}, {Encoding::motion_jpeg, {640, 480}, 0});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->pieces.at(0).length, 5000U);
}

TEST(PlanePlan, never_leaves_the_planes) {
  std::mt19937_64 random{fresh_seed()};
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
  int good = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::vector<BufferPlane> planes;
    for (std::size_t i = below(4); i > 0; --i)
      planes.push_back({static_cast<int>(below(4)) - 1, below(3) == 0 ? random() : below(200),
                        below(9) == 0 ? random() : below(200)});
    const PictureLayout layout{static_cast<Encoding>(below(5)),
                               {static_cast<int>(below(12)) - 1, static_cast<int>(below(12)) - 1},
                               below(20)};
    const auto plan = backend::plan_planes(planes, layout);
    if (!plan)
      continue;
    ++good;
    for (const auto& piece : plan->pieces) {
      ASSERT_LT(piece.file, plan->files.size());
      EXPECT_LE(piece.offset + piece.length, plan->files[piece.file].length);
      EXPECT_TRUE(std::any_of(planes.begin(), planes.end(), [&](const BufferPlane& plane) {
        return plane.descriptor == plan->files[piece.file].descriptor &&
               plane.offset == piece.offset;
      }));
    }
  }
  EXPECT_GT(good, 20);
}

backend::FileDescriptor memory(std::size_t bytes, unsigned char first) {
  backend::FileDescriptor file{::memfd_create("plane", MFD_CLOEXEC)};
  std::vector<unsigned char> contents(bytes);
  for (std::size_t i = 0; i < bytes; ++i)
    contents[i] = static_cast<unsigned char>(first + i);
  EXPECT_EQ(::write(file.get(), contents.data(), bytes), static_cast<ssize_t>(bytes));
  return file;
}

TEST(MappedPicture, puts_planes_together_without_allocating) {
  const auto luma = memory(32, 0);
  const auto chroma = memory(16, 100);
  const auto plan = backend::plan_planes({{luma.get(), 0, 32}, {chroma.get(), 0, 16}}, nv12);
  ASSERT_TRUE(plan);
  auto picture = backend::MappedPicture::map(*plan, nv12.bytes(), "camera");
  ASSERT_TRUE(picture) << picture.error().message;
  const auto before = allocations_of_this_thread();
  const auto bytes = picture->begin_reading();
  picture->end_reading();
  EXPECT_EQ(allocations_of_this_thread(), before);
  ASSERT_EQ(bytes.size(), nv12.bytes());
  const auto value = [&](std::size_t i) { return std::to_integer<std::size_t>(bytes[i]); };
  for (std::size_t i = 0; i < 30; ++i) // the last row of luma ends without padding
    EXPECT_EQ(value(i), i);
  for (std::size_t i = 32; i < bytes.size(); ++i)
    EXPECT_EQ(value(i), 100 + i - 32);
}

TEST(MappedPicture, reads_one_piece_where_it_lies) {
  const auto file = memory(8192, 0);
  const auto plan = backend::plan_planes({{file.get(), 10, 70}}, yuyv);
  ASSERT_TRUE(plan);
  auto picture = backend::MappedPicture::map(*plan, yuyv.bytes(), "camera");
  ASSERT_TRUE(picture) << picture.error().message;
  const auto bytes = picture->begin_reading();
  EXPECT_EQ(std::to_integer<int>(bytes[0]), 10);
  EXPECT_EQ(bytes.size(), yuyv.bytes());
}

TEST(MappedPicture, says_what_could_not_be_mapped) {
  EXPECT_THAT(backend::MappedPicture::map({{{-1, 4096}}, {{0, 0, 10, 0}}}, 10, "camera"),
              FailsSaying("mapping"));
}

} // namespace
} // namespace octascope::tests
