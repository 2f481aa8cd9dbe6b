// How alike two pictures are in structure: what a mean difference overlooks, a small shift or blur.
#pragma once

#include "pipeline/files/png_image.h"

namespace octascope::tests {

// Mean structural similarity of the luminances, 1 for equal pictures: windows of 11 x 11 pixels
// that lie wholly in the picture, Gaussian weights of standard deviation 1.5, K1 = 0.01, K2 = 0.03.
// Windows in which neither picture has any structure to compare do not count, or an empty
// background would hide what differs beside it; pictures of nothing else are judged by all windows.
// RGB of one size, at least 11 x 11. Source: Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image
// quality assessment: from error visibility to structural similarity", IEEE Trans. Image Processing
// 13(4), 2004; luminance by Rec. 601.
double structural_similarity(const pipeline::Image& a, const pipeline::Image& b);

} // namespace octascope::tests
