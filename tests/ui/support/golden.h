// Pictures against those kept in tests/golden.
//
// Software and hardware rasterisers differ in rounding and anti-aliasing, so a mean difference of
// up to 1.5 of 255 is accepted, and at most 0.5 % of the channels may differ by more than 40. To
// renew the pictures after a change that is meant, run the tests with OCTASCOPE_RENEW_GOLDEN=1 and
// look at what git shows as changed.
#pragma once

#include <string>

#include "pipeline/files/png_image.h"

namespace octascope::tests {

// Fails the running test, and says where the picture is to be seen, unless it is as in
// tests/golden/<name>.png. With `least_similarity` the structure is compared as well
// (structural_similarity.h), so that a shift by one pixel or a slight blur fails: for pictures of
// texture, of which the other measures would let that pass.
void expect_golden(const pipeline::Image& image, const std::string& name,
                   double least_similarity = 0);

// Pictures of one scene by two rasterisers are above it; one of texture that is moved by a pixel is
// far below.
inline constexpr double golden_similarity = 0.97;

} // namespace octascope::tests
