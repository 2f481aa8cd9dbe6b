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
#include "pipeline/recordings/raw/raw_reader.h"

namespace octascope::firmware_host {

namespace {

using hal::ErrorCode;
using hal::SampleType;

constexpr std::size_t most_lines = 65536; // that a mean is taken over: more tell nothing new

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
      values / static_cast<std::uintmax_t>(std::max(samples, 1)), 1, most_lines);
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
  constexpr std::size_t most_text_lines = 256;
  auto values = pipeline::read_text_numbers(
      file, samples ? most_text_lines * static_cast<std::size_t>(*samples)
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
  if (const auto fault = spectra.find_fault(0))
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

// The mean of lines that come in pieces.
class MeanOfLines {
public:
  MeanOfLines(const std::filesystem::path& file, std::size_t samples,
              std::optional<double> full_scale, bool refuse_saturated)
      : file_(file.string()), full_scale_(full_scale), refuse_saturated_(refuse_saturated),
        sum_(samples) {}

  hal::Result<> add(std::span<const double> lines) {
    for (; !lines.empty(); lines = lines.subspan(sum_.size()), ++lines_) {
      const std::span line = lines.first(sum_.size());
      if (refuse_saturated_)
        HAL_CHECK(check_saturation(fmt::format("{}: line {}", file_, lines_), line, full_scale_));
      for (std::size_t p = 0; p < sum_.size(); ++p)
        sum_[p] += line[p];
    }
    return {};
  }
  std::vector<double> mean() const {
    std::vector<double> mean = sum_;
    for (double& value : mean)
      value /= static_cast<double>(lines_);
    return mean;
  }

private:
  std::string file_;
  std::optional<double> full_scale_;
  bool refuse_saturated_;
  std::vector<double> sum_;
  std::size_t lines_ = 0;
};

// The kept lines of a recording of raw spectra, of whole volumes or not.
hal::Result<std::vector<double>> read_recorded_spectrum(const std::filesystem::path& file,
                                                        const SpectrumInput& input,
                                                        bool refuse_saturated) {
  HAL_TRY(const auto reader, pipeline::RawReader::open(file));
  const hal::LineFormat& format = reader.facts().format;
  if (reader.frames().empty())
    return hal::fail(ErrorCode::bad_data, "{}: found no lines in it, expected some", file.string());
  if (input.samples && *input.samples != format.samples_per_line)
    return hal::fail(ErrorCode::invalid_argument,
                     "--samples is {}, expected none, or {}, as {} says", *input.samples,
                     format.samples_per_line, file.string());
  const auto kept = static_cast<std::size_t>(reader.facts().kept_lines());
  const std::size_t frames = std::clamp<std::size_t>(most_lines / kept, 1, reader.frames().size());
  HAL_TRY(const auto spectra, reader.spectra(0, frames, pipeline::RawLines::kept));
  const bool counts = format.sample_type != SampleType::f32;
  const pipeline::SpectrumFormat spectrum{format};
  MeanOfLines mean{file, static_cast<std::size_t>(format.samples_per_line),
                   counts ? std::optional{static_cast<double>(spectrum.full_scale())}
                          : std::nullopt,
                   refuse_saturated};
  for (int b = 0; b < spectra.shape().b_scans; ++b) {
    if (const auto fault = spectra.find_fault(b))
      return hal::fail(ErrorCode::bad_data, *fault);
    std::vector<double> lines = to_numbers(spectra.b_scan(b), format.sample_type);
    for (double& value : lines)
      value = counts ? std::floor(std::ldexp(value, -format.right_shift)) : value;
    HAL_CHECK(mean.add(lines));
  }
  return mean.mean();
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

hal::Result<pipeline::SpectraFile> open_tissue(const std::filesystem::path& file,
                                               const TissueInput& input) {
  if (!pipeline::is_raw_recording(file))
    return pipeline::SpectraFile::open(file, input.shape.value_or(pipeline::SpectraShape{}),
                                       spectrum_type(file, input.type));
  HAL_TRY(const auto reader, pipeline::RawReader::open(file));
  HAL_TRY(const auto volume, reader.first_whole_volume());
  HAL_TRY(auto spectra, reader.spectra(volume.first, volume.count, pipeline::RawLines::kept));
  if (input.shape && *input.shape != spectra.shape())
    return hal::fail(ErrorCode::invalid_argument,
                     "--shape is another one than {} says: expected "
                     "none, or {},{},{}",
                     file.string(), spectra.shape().b_scans, spectra.shape().a_scans,
                     spectra.shape().samples);
  return spectra;
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
  if (pipeline::is_raw_recording(file))
    return read_recorded_spectrum(file, input, refuse_saturated);
  const SampleType type = spectrum_type(file, input.type);
  HAL_TRY(const auto recording, read_recording(file, input, type));
  std::optional<double> full_scale;
  if (type != SampleType::f32 && (!is_text(file) || input.significant_bits))
    full_scale =
        std::ldexp(1.0, input.significant_bits.value_or(type == SampleType::u8 ? 8 : 16)) - 1;

  MeanOfLines mean{file, recording.samples, full_scale, refuse_saturated};
  HAL_CHECK(mean.add(recording.values));
  return mean.mean();
}

} // namespace octascope::firmware_host
