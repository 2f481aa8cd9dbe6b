#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/spectra/recorded_spectra.h"

namespace octascope::sim {
namespace {

using testing::HasSubstr;

// Two B-scans of four A-scans of three samples; a sample is 100·b + 10·a + n.
SpectraRecording recording() {
  auto counts = std::make_shared<std::vector<std::uint16_t>>();
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 4; ++a)
      for (int n = 0; n < 3; ++n)
        counts->push_back(static_cast<std::uint16_t>(100 * b + 10 * a + n));
  return {.samples = std::as_bytes(std::span{*counts}),
          .b_scans = 2,
          .a_scans = 4,
          .samples_per_line = 3,
          .name = "mirror.raw",
          .keep_alive = counts};
}

std::vector<int> first_samples(std::span<const std::byte> frame) {
  std::vector<int> firsts;
  for (std::size_t i = 0; i < frame.size(); i += 6)
    firsts.push_back(std::to_integer<int>(frame[i]) + 256 * std::to_integer<int>(frame[i + 1]));
  return firsts;
}

TEST(RecordedSpectra, plays_the_recording_where_it_lies_for_ever) {
  const SpectraRecording original = recording();
  const auto made = RecordedSpectra::make(original);
  ASSERT_TRUE(made);
  const RecordedSpectra& spectra = **made;
  EXPECT_EQ(spectra.format(), (hal::LineFormat{.samples_per_line = 3,
                                               .lines_per_frame = 4,
                                               .sample_type = hal::SampleType::u16,
                                               .significant_bits = 16,
                                               .right_shift = 0}));
  EXPECT_EQ(spectra.sweeps(), 2);
  EXPECT_EQ(spectra.frame(7, 0).data(), original.samples.data());
  EXPECT_EQ(first_samples(spectra.frame(1'000'000, 1)), (std::vector{100, 110, 120, 130}));
  EXPECT_THAT(spectra.description(), HasSubstr("recording mirror.raw"));
}

// As those of a recording that keeps them apart.
TEST(RecordedSpectra, plays_one_volume_after_the_other) {
  SpectraRecording apart = recording();
  const auto samples = std::exchange(apart.samples, {});
  const std::size_t sweep = samples.size() / 2;
  for (const unsigned n : {0U, 1U, 1U, 0U}) // the second volume has its sweeps changed
    apart.sweeps.push_back(samples.subspan(n * sweep, sweep));
  const auto made = RecordedSpectra::make(apart);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ((*made)->sweeps(), 2);
  for (const unsigned volume : {0U, 2U, 4U}) {
    EXPECT_EQ(first_samples((*made)->frame(volume, 1))[0], 100);
    EXPECT_EQ(first_samples((*made)->frame(volume + 1, 1))[0], 0);
  }
  EXPECT_THAT((*made)->description(), HasSubstr("2 volumes of 2 B-scans"));
  apart.sweeps.pop_back();
  EXPECT_THAT(RecordedSpectra::make(apart).error().message, HasSubstr("found 3 sweeps"));
}

TEST(RecordedSpectra, keeps_what_it_plays_alive) {
  SpectraRecording original = recording();
  const std::weak_ptr<const void> memory = original.keep_alive;
  auto made = RecordedSpectra::make(std::move(original));
  original = {};
  EXPECT_FALSE(memory.expired());
  made->reset();
  EXPECT_TRUE(memory.expired());
}

TEST(RecordedSpectra, fly_back_lines_run_backwards) {
  const auto two = RecordedSpectra::make(recording(), 2);
  ASSERT_TRUE(two);
  EXPECT_EQ((*two)->format().lines_per_frame, 6);
  EXPECT_EQ(first_samples((*two)->frame(0, 1)), (std::vector{100, 110, 120, 130, 130, 100}));
  const auto four = RecordedSpectra::make(recording(), 4);
  EXPECT_EQ(first_samples((*four)->frame(0, 0)), (std::vector{0, 10, 20, 30, 30, 20, 10, 0}));
  EXPECT_EQ(first_samples((*RecordedSpectra::make(recording(), 1))->frame(0, 0)).size(), 5U);
}

TEST(RecordedSpectra, refuses_shapes_that_do_not_fit) {
  const auto complaint = [](auto change, int fly_back_lines = 0) {
    SpectraRecording r = recording();
    change(r);
    const auto made = RecordedSpectra::make(std::move(r), fly_back_lines);
    return made ? "" : made.error().message;
  };
  EXPECT_EQ(complaint([](auto& r) { r.b_scans = 3; }),
            "mirror.raw: has 24 samples, expected 36 for 3 B-scans of 4 A-scans of 3 samples");
  EXPECT_THAT(complaint([](auto& r) { r.b_scans = 0; }), HasSubstr("B-scans is 0"));
  EXPECT_THAT(complaint([](auto& r) { r.a_scans = -1; }), HasSubstr("A-scans is -1"));
  EXPECT_THAT(complaint([](auto& r) { r.samples_per_line = 1 << 20; }), HasSubstr("expected 1 to"));
  EXPECT_THAT(complaint([](auto& r) { r.significant_bits = 17; }), HasSubstr("17"));
  EXPECT_THAT(complaint([](auto&) {}, -1), HasSubstr("fly_back_lines is -1"));
}

} // namespace
} // namespace octascope::sim
