#include "ui/transfer/look_up_table_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pipeline/files/file_name.h"
#include "pipeline/files/png_image.h"
#include "pipeline/files/text_curve.h"
#include "ui/transfer/transfer_curve.h"

namespace octascope::ui {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

constexpr std::size_t most_entries = TransferCurve::most_entries;

hal::Result<LookUpTable> read_text(const fs::path& file) {
  HAL_TRY(const auto rows, pipeline::read_text_rows(file, most_entries, {1, 4}));
  if (rows.size() < 2)
    return hal::fail(ErrorCode::bad_data, "{}: found {} entries, expected 2 to {}, one a line",
                     file.string(), rows.size(), most_entries);
  LookUpTable table;
  std::vector<TransferTable::Colour> colours;
  for (const pipeline::TextRow& row : rows) {
    for (const double value : row.numbers)
      if (value < 0 || value > 1)
        return hal::fail(
            ErrorCode::bad_data,
            "{}:{}: found {}, expected numbers from 0 to 1; divide all by their highest, as 255",
            file.string(), row.line, value);
    table.opacities.push_back(static_cast<float>(row.numbers.back()));
    if (row.numbers.size() == 4)
      colours.push_back({static_cast<float>(row.numbers[0]), static_cast<float>(row.numbers[1]),
                         static_cast<float>(row.numbers[2])});
  }
  if (!colours.empty())
    table.colours = std::move(colours);
  return table;
}

// The picture's longer side along `entries`, the other across.
class Strip {
public:
  explicit Strip(const pipeline::NumberImage& image)
      : image_{image}, lies_{image.width >= image.height}, entries_{static_cast<std::size_t>(
                                                               std::max(image.width,
                                                                        image.height))},
        rows_{static_cast<std::size_t>(std::min(image.width, image.height))} {}

  std::size_t entries() const { return entries_; }
  std::size_t rows() const { return rows_; }
  std::span<const std::uint16_t> pixel(std::size_t entry, std::size_t row) const {
    const auto channels = static_cast<std::size_t>(image_.channels);
    const std::size_t at = lies_ ? row * entries_ + entry : entry * rows_ + row;
    return std::span{image_.values}.subspan(at * channels, channels);
  }

private:
  const pipeline::NumberImage& image_;
  bool lies_;
  std::size_t entries_;
  std::size_t rows_;
};

hal::Result<> check(const fs::path& file, const pipeline::NumberImage& image, const Strip& strip) {
  const auto refuse = [&](std::string found) {
    return hal::fail(ErrorCode::bad_data,
                     "{}: found {}, expected a strip of 2 to {} pixels whose rows along it are all "
                     "the same; draw it one pixel wide",
                     file.string(), found, most_entries);
  };
  if (strip.entries() < 2 || strip.entries() > most_entries)
    return refuse(fmt::format("{}x{} pixels", image.width, image.height));
  for (std::size_t row = 1; row < strip.rows(); ++row)
    for (std::size_t entry = 0; entry < strip.entries(); ++entry)
      if (!std::ranges::equal(strip.pixel(entry, row), strip.pixel(entry, 0)))
        return refuse(fmt::format("row {} other than row 1 at pixel {}", row + 1, entry + 1));
  return {};
}

hal::Result<LookUpTable> read_strip(const fs::path& file) {
  HAL_TRY(const auto image, pipeline::read_png_numbers(file, most_entries));
  const Strip strip{image};
  HAL_CHECK(check(file, image, strip));
  LookUpTable table;
  std::vector<TransferTable::Colour> colours;
  for (std::size_t entry = 0; entry < strip.entries(); ++entry) {
    std::array<float, 4> values{};
    std::ranges::transform(strip.pixel(entry, 0), values.begin(), [&](std::uint16_t value) {
      return static_cast<float>(value) / static_cast<float>(image.greatest);
    });
    const float ramp = static_cast<float>(entry) / static_cast<float>(strip.entries() - 1);
    const bool grey = image.channels <= 2;
    const bool with_opacity = image.channels % 2 == 0;
    table.opacities.push_back(with_opacity ? values[static_cast<std::size_t>(image.channels) - 1]
                              : grey       ? values[0]
                                           : ramp);
    if (image.channels > 1)
      colours.push_back({values[0], values[grey ? 0 : 1], values[grey ? 0 : 2]});
  }
  if (!colours.empty())
    table.colours = std::move(colours);
  return table;
}

} // namespace

hal::Result<LookUpTable> read_look_up_table(const fs::path& file) {
  return pipeline::file_ending(file) == ".png" ? read_strip(file) : read_text(file);
}

} // namespace octascope::ui
