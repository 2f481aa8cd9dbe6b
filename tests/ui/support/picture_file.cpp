#include "tests/ui/support/picture_file.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <png.h>

namespace octascope::tests {

std::optional<ui::Image> read_png(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, file.c_str()) == 0)
    return std::nullopt;
  png.format = PNG_FORMAT_RGB;
  ui::Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) == 0)
    return std::nullopt;
  return image;
}

bool write_png(const ui::Image& image, const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  return png_image_write_to_file(&png, file.c_str(), 0, image.rgb.data(), 0, nullptr) != 0;
}

PictureDifference compare(const ui::Image& a, const ui::Image& b) {
  if (a.rgb.size() != b.rgb.size() || a.width != b.width || a.rgb.empty())
    return {};
  PictureDifference difference{0, 0};
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const int d = std::abs(int{a.rgb[i]} - int{b.rgb[i]});
    difference.mean += d;
    difference.largest = std::max(difference.largest, d);
  }
  difference.mean /= static_cast<double>(a.rgb.size());
  return difference;
}

std::filesystem::path picture_folder() {
  const char* folder = std::getenv("OCTASCOPE_PICTURES");
  return folder != nullptr ? std::filesystem::path{folder} : std::filesystem::temp_directory_path();
}

} // namespace octascope::tests
