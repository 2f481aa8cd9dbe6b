#include "firmware-host/commands/calibrate/calibrate_inputs.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/files/file_name.h"
#include "pipeline/files/text_curve.h"

namespace octascope::firmware_host {

namespace {

using hal::ErrorCode;
using hal::SampleType;

template <class Sample> std::vector<double> numbers_of(std::span<const std::byte> bytes) {
  std::vector<double> values(bytes.size() / sizeof(Sample));
  for (std::size_t i = 0; i < values.size(); ++i) {
    Sample sample{};
    std::memcpy(&sample, bytes.data() + i * sizeof(Sample), sizeof(Sample));
    values[i] = static_cast<double>(sample);
  }
  return values;
}

hal::Result<pipeline::SpectraShape> shape_of(const std::filesystem::path& file,
                                             const SpectrumInput& input, SampleType type) {
  std::error_code error;
  const std::uintmax_t bytes =
      std::filesystem::is_regular_file(file, error) ? std::filesystem::file_size(file, error) : 0;
  const std::uintmax_t values = bytes / bytes_per_sample(type);
  const auto most = static_cast<std::uintmax_t>(pipeline::most_samples);
  if (!input.samples && values > most)
    return hal::fail(
        ErrorCode::invalid_argument,
        "{}: found {} samples, more than a line has; say with --samples how many make one line",
        file.string(), values);
  // Of a file that is missing or empty, the reader speaks.
  const int samples = input.samples.value_or(
      values < static_cast<std::uintmax_t>(pipeline::fewest_samples) ? pipeline::fewest_samples
                                                                     : static_cast<int>(values));
  const std::uintmax_t lines = std::clamp<std::uintmax_t>(
      values / static_cast<std::uintmax_t>(std::max(samples, 1)), 1, 65536);
  return pipeline::SpectraShape{1, static_cast<int>(lines), samples};
}

// The first of at least four samples in a row at the line's highest value, when that happens more
// than once: a slow fringe in few bits has one flat top, a clipped one has many.
std::optional<std::size_t> find_plateau(std::span<const double> line) {
  constexpr int fewest = 4; // noise does not do that
  const double highest = *std::ranges::max_element(line);
  if (highest <= *std::ranges::min_element(line))
    return std::nullopt;
  std::optional<std::size_t> first;
  int run = 0;
  for (std::size_t p = 0; p < line.size(); ++p) {
    run = line[p] >= highest ? run + 1 : 0;
    if (run == fewest && first)
      return first;
    if (run == fewest)
      first = p + 1 - fewest;
  }
  return std::nullopt;
}

hal::Result<> check_saturation(const std::string& place, std::span<const double> line,
                               std::optional<double> full_scale) {
  for (std::size_t p = 0; full_scale && p < line.size(); ++p) {
    if (line[p] >= *full_scale)
      return hal::fail(
          ErrorCode::bad_data,
          "{}: saturated: sample {} is {}, expected less than {}; measure with less light", place,
          p, line[p], *full_scale);
  }
  if (const auto plateau = find_plateau(line))
    return hal::fail(
        ErrorCode::bad_data,
        "{}: saturated: samples {} to {} are all {}, the highest value; measure with less light",
        place, *plateau, *plateau + 3, line[*plateau]);
  return {};
}

// Numbers as text, whole lines of a spectrum.
hal::Result<std::vector<double>> read_text(const std::filesystem::path& file,
                                           std::optional<int> samples) {
  constexpr std::size_t most_lines = 256;
  auto values =
      pipeline::read_text_numbers(file, samples ? most_lines * static_cast<std::size_t>(*samples)
                                                : static_cast<std::size_t>(pipeline::most_samples));
  if (!values)
    return values;
  const std::size_t n = samples ? static_cast<std::size_t>(*samples) : values->size();
  if (values->size() < static_cast<std::size_t>(pipeline::fewest_samples) ||
      values->size() % n != 0)
    return hal::fail(ErrorCode::bad_data, "{}: found {} numbers, expected {}", file.string(),
                     values->size(),
                     samples ? fmt::format("lines of {} samples", n)
                             : fmt::format("at least {}", pipeline::fewest_samples));
  return values;
}

struct Recording {
  std::vector<double> values; // line after line
  std::size_t samples = 0;    // of a line
};

hal::Result<Recording> read_raw(const std::filesystem::path& file, const SpectrumInput& input,
                                SampleType type) {
  HAL_TRY(const auto shape, shape_of(file, input, type));
  HAL_TRY(const auto spectra, pipeline::SpectraFile::open(file, shape, type));
  if (const auto fault = spectra.find_non_finite(0))
    return hal::fail(ErrorCode::bad_data, *fault);
  return Recording{to_numbers(spectra.b_scan(0), type), static_cast<std::size_t>(shape.samples)};
}

hal::Result<Recording> read_recording(const std::filesystem::path& file, const SpectrumInput& input,
                                      SampleType type) {
  if (!is_text(file))
    return read_raw(file, input, type);
  HAL_TRY(auto values, read_text(file, input.samples));
  const std::size_t samples =
      input.samples ? static_cast<std::size_t>(*input.samples) : values.size();
  return Recording{std::move(values), samples};
}

} // namespace

bool is_text(const std::filesystem::path& file) {
  const std::string ending = pipeline::file_ending(file);
  return ending == ".txt" || ending == ".csv";
}

SampleType spectrum_type(const std::filesystem::path& file, std::optional<SampleType> given) {
  if (given)
    return *given;
  const std::string name = pipeline::small_letters(file.filename().string());
  if (name.find("f32") != std::string::npos)
    return SampleType::f32;
  if (name.find("u8") != std::string::npos && name.find("u16") == std::string::npos)
    return SampleType::u8;
  return SampleType::u16;
}

std::vector<double> to_numbers(std::span<const std::byte> bytes, SampleType type) {
  switch (type) {
  case SampleType::u8: return numbers_of<std::uint8_t>(bytes);
  case SampleType::u16: return numbers_of<std::uint16_t>(bytes);
  case SampleType::f32: break;
  }
  return numbers_of<float>(bytes);
}

hal::Result<std::vector<double>> read_spectrum(const std::filesystem::path& file,
                                               const SpectrumInput& input, bool refuse_saturated) {
  const SampleType type = spectrum_type(file, input.type);
  HAL_TRY(const auto recording, read_recording(file, input, type));
  const std::size_t n = recording.samples;
  const std::size_t lines = recording.values.size() / n;
  std::optional<double> full_scale;
  if (type != SampleType::f32 && (!is_text(file) || input.significant_bits))
    full_scale =
        std::ldexp(1.0, input.significant_bits.value_or(type == SampleType::u8 ? 8 : 16)) - 1;

  std::vector<double> mean(n);
  for (std::size_t a = 0; a < lines; ++a) {
    const std::span line = std::span{recording.values}.subspan(a * n, n);
    const std::string place = fmt::format("{}: line {}", file.string(), a);
    if (const auto checked = check_saturation(place, line, full_scale);
        refuse_saturated && !checked)
      return tl::make_unexpected(checked.error());
    for (std::size_t p = 0; p < n; ++p)
      mean[p] += line[p] / static_cast<double>(lines);
  }
  return mean;
}

} // namespace octascope::firmware_host
