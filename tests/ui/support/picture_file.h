// How far two pictures are apart, and where to put those that are too far.
#pragma once

#include <filesystem>

#include "pipeline/files/png_image.h"

namespace octascope::tests {

// Over all channels of all pixels, in counts of 255.
struct PictureDifference {
  double mean = 255;
  int largest = 255;
};
PictureDifference compare(const pipeline::Image& a, const pipeline::Image& b);

// Where the pictures of a failed test go, and of every test if OCTASCOPE_PICTURES names a folder.
std::filesystem::path picture_folder();

} // namespace octascope::tests
