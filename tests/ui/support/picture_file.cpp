#include "tests/ui/support/picture_file.h"

#include <algorithm>
#include <cstdlib>

namespace octascope::tests {

PictureDifference compare(const pipeline::Image& a, const pipeline::Image& b) {
  if (a.pixels.size() != b.pixels.size() || a.width != b.width || a.pixels.empty())
    return {};
  PictureDifference difference{0, 0};
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const int d = std::abs(int{a.pixels[i]} - int{b.pixels[i]});
    difference.mean += d;
    difference.largest = std::max(difference.largest, d);
  }
  difference.mean /= static_cast<double>(a.pixels.size());
  return difference;
}

std::filesystem::path picture_folder() {
  const char* folder = std::getenv("OCTASCOPE_PICTURES");
  return folder != nullptr ? std::filesystem::path{folder} : std::filesystem::temp_directory_path();
}

} // namespace octascope::tests
