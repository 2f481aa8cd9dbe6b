#include "sim/spectra/recorded_spectra.h"

#include <algorithm>

#include <fmt/format.h>

namespace octascope::sim {

using hal::ErrorCode;

namespace {

constexpr int most = 65536; // of each count: keeps their product within 64 bits

hal::Result<> check_count(const SpectraRecording& recording, const char* what, int found,
                          int lowest, int highest) {
  if (found >= lowest && found <= highest)
    return {};
  return hal::fail(ErrorCode::invalid_argument, "{}: {} is {}, expected {} to {}", recording.name,
                   what, found, lowest, highest);
}

hal::Result<> check_sweeps(const SpectraRecording& r, int fly_back_lines) {
  const std::size_t bytes = static_cast<std::size_t>(r.a_scans) *
                            static_cast<std::size_t>(r.samples_per_line) * bytes_per_sample(r.type);
  const bool fit = std::ranges::all_of(r.sweeps, [&](const auto& s) { return s.size() == bytes; });
  if (fit && fly_back_lines == 0 && r.sweeps.size() % static_cast<std::size_t>(r.b_scans) == 0)
    return {};
  return hal::fail(ErrorCode::invalid_argument,
                   "{}: found {} sweeps, expected whole volumes of {} sweeps of {} bytes, and no "
                   "fly-back added to them",
                   r.name, r.sweeps.size(), r.b_scans, bytes);
}

hal::Result<> check_size(const SpectraRecording& r, int fly_back_lines) {
  if (!r.sweeps.empty())
    return check_sweeps(r, fly_back_lines);
  const std::uint64_t expected = static_cast<std::uint64_t>(r.b_scans) *
                                 static_cast<std::uint64_t>(r.a_scans) *
                                 static_cast<std::uint64_t>(r.samples_per_line);
  const std::uint64_t found = r.samples.size() / bytes_per_sample(r.type);
  if (found == expected)
    return {};
  return hal::fail(ErrorCode::invalid_argument,
                   "{}: has {} samples, expected {} for {} B-scans of {} A-scans of {} samples",
                   r.name, found, expected, r.b_scans, r.a_scans, r.samples_per_line);
}

} // namespace

hal::Result<std::unique_ptr<RecordedSpectra>> RecordedSpectra::make(SpectraRecording recording,
                                                                    int fly_back_lines) {
  const SpectraRecording& r = recording;
  HAL_CHECK(
      check_count(r, "the number of B-scans", r.b_scans, 1, most)
          .and_then([&] { return check_count(r, "the number of A-scans", r.a_scans, 1, most); })
          .and_then(
              [&] { return check_count(r, "the number of samples", r.samples_per_line, 1, most); })
          .and_then([&] { return check_count(r, "significant_bits", r.significant_bits, 1, 16); })
          .and_then([&] { return check_count(r, "right_shift", r.right_shift, 0, 15); })
          .and_then([&] { return check_count(r, "fly_back_lines", fly_back_lines, 0, most); })
          .and_then([&] { return check_size(r, fly_back_lines); }));
  return std::unique_ptr<RecordedSpectra>{
      new RecordedSpectra{std::move(recording), fly_back_lines}};
}

RecordedSpectra::RecordedSpectra(SpectraRecording recording, int fly_back_lines)
    : recording_(std::move(recording)), format_{.samples_per_line = recording_.samples_per_line,
                                                .lines_per_frame =
                                                    recording_.a_scans + fly_back_lines,
                                                .sample_type = recording_.type,
                                                .significant_bits = recording_.significant_bits,
                                                .right_shift = recording_.right_shift} {
  if (fly_back_lines > 0)
    add_fly_back(fly_back_lines);
  if (recording_.sweeps.empty())
    split(fly_back_lines > 0 ? with_fly_back_ : recording_.samples);
}

void RecordedSpectra::split(std::span<const std::byte> frames) {
  for (; !frames.empty(); frames = frames.subspan(format_.frame_bytes()))
    recording_.sweeps.push_back(frames.first(format_.frame_bytes()));
}

void RecordedSpectra::add_fly_back(int fly_back_lines) {
  const std::size_t line = format_.line_bytes();
  const auto a_scans = static_cast<std::size_t>(recording_.a_scans);
  const auto back = static_cast<std::size_t>(fly_back_lines);
  with_fly_back_.resize(static_cast<std::size_t>(recording_.b_scans) * (a_scans + back) * line);
  auto out = with_fly_back_.begin();
  for (auto rest = recording_.samples; !rest.empty(); rest = rest.subspan(a_scans * line)) {
    out = std::copy_n(rest.begin(), a_scans * line, out);
    for (std::size_t i = 0; i < back; ++i) {
      // Evenly from the last A-scan back to the first.
      const std::size_t a = (a_scans - 1) * (back - 1 - i) / std::max<std::size_t>(back - 1, 1);
      out = std::copy_n(rest.begin() + static_cast<std::ptrdiff_t>(a * line), line, out);
    }
  }
}

std::span<const std::byte> RecordedSpectra::frame(std::uint64_t volume, int b_scan) const {
  const auto b_scans = static_cast<std::size_t>(recording_.b_scans);
  const std::size_t volumes = recording_.sweeps.size() / b_scans;
  return recording_.sweeps[volume % volumes * b_scans + static_cast<std::size_t>(b_scan)];
}

std::string RecordedSpectra::description() const {
  const std::size_t volumes =
      recording_.sweeps.size() / static_cast<std::size_t>(recording_.b_scans);
  return fmt::format("recording {}, {} of {} B-scans, looped", recording_.name,
                     volumes == 1 ? "one volume" : fmt::format("{} volumes", volumes),
                     recording_.b_scans);
}

} // namespace octascope::sim
