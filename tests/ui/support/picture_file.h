// Pictures as PNG files, and how far two of them are apart.
#pragma once

#include <filesystem>
#include <optional>

#include "ui/image.h"

namespace octascope::tests {

std::optional<ui::Image> read_png(const std::filesystem::path& file);
bool write_png(const ui::Image& image, const std::filesystem::path& file);

// Over all channels of all pixels, in counts of 255.
struct PictureDifference {
  double mean = 255;
  int largest = 255;
};
PictureDifference compare(const ui::Image& a, const ui::Image& b);

// Where the pictures of a failed test go, and of every test if OCTASCOPE_PICTURES names a folder.
std::filesystem::path picture_folder();

} // namespace octascope::tests
