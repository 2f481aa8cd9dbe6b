#include "pipeline/reconstruction/spectra_file.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "hal/number_text.h"
#include "pipeline/files/crc32.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

// With these, no product of counts leaves 64 bits.
constexpr int most_b_scans = 1 << 20;
constexpr int most_a_scans = 65536;

hal::Result<> check(const SpectraShape& shape) {
  const auto refuse = [](std::string_view name, int found, int lowest, int highest) {
    return hal::fail(ErrorCode::invalid_argument, "shape: {} is {}, expected {} to {}", name, found,
                     lowest, highest);
  };
  if (shape.b_scans < 1 || shape.b_scans > most_b_scans)
    return refuse("B (B-scans)", shape.b_scans, 1, most_b_scans);
  if (shape.a_scans < 1 || shape.a_scans > most_a_scans)
    return refuse("A (A-scans per B-scan)", shape.a_scans, 1, most_a_scans);
  if (shape.samples < fewest_samples || shape.samples > most_samples)
    return refuse("N (samples per line)", shape.samples, fewest_samples, most_samples);
  return {};
}

} // namespace

hal::Result<SpectraShape> SpectraShape::parse(std::string_view text) {
  const auto refuse = [&] {
    return hal::fail(ErrorCode::invalid_argument,
                     "shape: found \"{}\", expected B,A,N: three whole numbers that fit into 31 "
                     "bits, like 100,100,1024",
                     text);
  };
  std::array<int, 3> counts{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == counts.size()))
      return refuse();
    const auto count = hal::number_of<int>(rest.substr(0, comma));
    if (!count)
      return refuse();
    counts[i] = *count;
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  }
  const SpectraShape shape{counts[0], counts[1], counts[2]};
  HAL_CHECK(check(shape));
  return shape;
}

hal::Result<SpectraFile> SpectraFile::open(const fs::path& file, const SpectraShape& shape,
                                           hal::SampleType type) {
  HAL_CHECK(check(shape));
  const std::size_t expected =
      shape.lines() * static_cast<std::size_t>(shape.samples) * bytes_per_sample(type);
  const std::string product =
      fmt::format("{} bytes = {} B-scans × {} A-scans × {} samples × {}", expected, shape.b_scans,
                  shape.a_scans, shape.samples, bytes_per_sample(type));
  HAL_TRY(const auto input, InputFile::open(file, product, UINT64_MAX));
  if (input.bytes() != expected)
    return hal::fail(ErrorCode::bad_data, "{}: found {} bytes, expected {}", file.string(),
                     input.bytes(), product);
  HAL_TRY(auto mapped, input.map());
  return SpectraFile{file, shape, type, std::move(mapped)};
}

hal::Result<SpectraFile> SpectraFile::open(const fs::path& file, Sweeps sweeps) {
  const SpectraShape shape{static_cast<int>(std::min<std::size_t>(sweeps.places.size(), INT_MAX)),
                           sweeps.kept_lines, sweeps.samples};
  HAL_CHECK(check(shape));
  HAL_TRY(const auto input, InputFile::open(file, "raw spectra", UINT64_MAX));
  HAL_TRY(auto mapped, input.map());
  SpectraFile opened{file, shape, sweeps.type, std::move(mapped)};
  const std::uint64_t bytes = opened.line_bytes() * static_cast<std::size_t>(sweeps.lines);
  const std::uint64_t file_bytes = opened.mapped_.bytes().size();
  for (const SweepPlace& place : sweeps.places)
    if (place.offset > file_bytes || bytes > file_bytes - place.offset ||
        place.offset % bytes_per_sample(sweeps.type) != 0)
      return hal::fail(
          ErrorCode::bad_data,
          "{}: found a sweep of {} bytes at byte {} of {}, expected it within the file, "
          "at a multiple of {}: the file was truncated, or is damaged",
          file.string(), bytes, place.offset, file_bytes, bytes_per_sample(sweeps.type));
  opened.lines_ = sweeps.lines;
  opened.places_ = std::move(sweeps.places);
  return opened;
}

std::span<const std::byte> SpectraFile::b_scan(int b) const {
  const std::size_t size = line_bytes() * static_cast<std::size_t>(shape_.a_scans);
  const auto n = static_cast<std::size_t>(b);
  return mapped_.bytes().subspan(places_.empty() ? size * n : places_[n].offset, size);
}

std::optional<std::string> SpectraFile::find_fault(int b) const {
  if (places_.empty())
    return find_non_finite(b);
  const SweepPlace& place = places_[static_cast<std::size_t>(b)];
  const auto whole =
      mapped_.bytes().subspan(place.offset, line_bytes() * static_cast<std::size_t>(lines_));
  const std::uint32_t found = crc32_of(whole);
  if (found != place.crc32)
    return fmt::format("{}: sweep {}, at byte {}, is damaged: found the checksum {:08x}, expected "
                       "{:08x}; take another copy of the file",
                       file_.string(), b, place.offset, found, place.crc32);
  return find_non_finite(b);
}

std::optional<std::string> SpectraFile::find_non_finite(int b) const {
  if (type_ != hal::SampleType::f32)
    return std::nullopt;
  const std::span<const std::byte> bytes = b_scan(b);
  const std::span floats{reinterpret_cast<const float*>(bytes.data()),
                         bytes.size() / sizeof(float)};
  const auto found =
      std::ranges::find_if(floats, [](float value) { return !std::isfinite(value); });
  if (found == floats.end())
    return std::nullopt;
  return fmt::format("{} is {}, expected a finite number",
                     place_of(b, static_cast<std::size_t>(found - floats.begin())), *found);
}

std::string SpectraFile::place_of(int b, std::size_t index) const {
  const auto samples = static_cast<std::size_t>(shape_.samples);
  return fmt::format("{}: B-scan {}, A-scan {}, sample {}", file_.string(), b, index / samples,
                     index % samples);
}

template <class Count>
std::optional<std::string> SpectraFile::find_above(int b, const SpectrumFormat& format) const {
  const std::span<const std::byte> bytes = b_scan(b);
  const std::span counts{reinterpret_cast<const Count*>(bytes.data()),
                         bytes.size() / sizeof(Count)};
  const std::uint32_t full_scale = format.full_scale();
  const auto found = std::ranges::find_if(counts, [&](Count count) {
    return static_cast<std::uint32_t>(count >> format.right_shift) > full_scale;
  });
  if (found == counts.end())
    return std::nullopt;
  return fmt::format("{} is {}, expected at most {}: {} bits{}",
                     place_of(b, static_cast<std::size_t>(found - counts.begin())), *found,
                     full_scale << format.right_shift, format.significant_bits,
                     format.right_shift > 0
                         ? fmt::format(" behind a shift of {}", format.right_shift)
                         : std::string{});
}

std::optional<std::string> SpectraFile::find_above_full_scale(int b,
                                                              const SpectrumFormat& format) const {
  switch (type_) {
  case hal::SampleType::u8: return find_above<std::uint8_t>(b, format);
  case hal::SampleType::u16: return find_above<std::uint16_t>(b, format);
  case hal::SampleType::f32: break;
  }
  return std::nullopt;
}

} // namespace octascope::pipeline
