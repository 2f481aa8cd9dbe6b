// A small recording of raw spectra, whose frames differ from each other in every sample.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <vector>

#include "pipeline/recordings/raw/raw_writer.h"

namespace octascope::tests {

inline pipeline::RawFacts small_raw_facts() {
  pipeline::RawFacts facts;
  facts.plan.samples = 16;
  facts.plan.a_scans = 5;
  facts.plan.fly_back_lines = 2;
  facts.plan.b_scans = 3;
  facts.plan.repeats = 2;
  facts.plan.refractive_index = 1.38;
  facts.format = {.samples_per_line = 16,
                  .lines_per_frame = facts.plan.lines_per_frame(),
                  .sample_type = hal::SampleType::u16,
                  .significant_bits = 12,
                  .right_shift = 4};
  facts.recorded_by = "octascope, in a test";
  facts.begun = "2026-11-22T12:10:03+01:00";
  facts.source = "phantom eye";
  facts.simulated = true;
  facts.subject = "Müller, 17";
  facts.eye = pipeline::Eye::left;
  facts.configuration = "# none\n";
  facts.calibration = pipeline::Calibration::identity(16);
  facts.calibration.dispersion_rad.assign(16, 0.1234567890123456789);
  facts.path = "fused";
  facts.isa = "AVX2";
  return facts;
}

inline std::vector<std::uint16_t> small_raw_samples(std::uint64_t n) {
  std::vector<std::uint16_t> samples(small_raw_facts().format.frame_bytes() / 2);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<std::uint16_t>((i * 7 + n * 311) % 4000 << 4);
  return samples;
}

inline std::vector<float> small_raw_background(std::uint64_t n) {
  return std::vector<float>(16, 1000.1F + static_cast<float>(n));
}

// The `n`th of a run from its first volume on.
inline pipeline::RawFrame small_raw_frame(std::uint64_t n) {
  const pipeline::ScanPlan plan = small_raw_facts().plan;
  const auto sweep = static_cast<int>(n % static_cast<std::uint64_t>(plan.sweeps()));
  const auto ns = static_cast<std::int64_t>(100'000'000'000 + n * 1'000'000);
  return {.volume = 1 + n / static_cast<std::uint64_t>(plan.sweeps()),
          .b_scan = plan.b_scan_of(sweep),
          .repeat = sweep % plan.repeats,
          .sequence = n,
          .first_line_ns = ns,
          .last_line_ns = ns + 900'000,
          .wall_clock_ns = 1'795'345'803'000'000'000 + ns,
          .scan_lag_a_scans = 0.25};
}

inline void append_small_raw(pipeline::RawWriter& writer, std::uint64_t n) {
  const std::vector<std::uint16_t> samples = small_raw_samples(n);
  const auto appended =
      writer.append(small_raw_frame(n), std::as_bytes(std::span{samples}), small_raw_background(n));
  if (!appended)
    throw std::runtime_error{appended.error().message};
}

inline void write_small_raw(const std::filesystem::path& file, std::uint64_t frames) {
  auto writer = pipeline::RawWriter::create(file, small_raw_facts());
  if (!writer)
    throw std::runtime_error{writer.error().message};
  for (std::uint64_t n = 0; n < frames; ++n)
    append_small_raw(*writer, n);
  const auto finished = writer->finish({.not_kept = 2, .camera = "a camera"});
  if (!finished)
    throw std::runtime_error{finished.error().message};
}

} // namespace octascope::tests
