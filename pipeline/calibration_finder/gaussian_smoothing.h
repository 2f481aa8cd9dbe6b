// A Gaussian moving average.
#pragma once

#include <span>
#include <vector>

namespace octascope::pipeline {

// Weighted mean of the values around each one, standard deviation `sigma` in samples, cut off at
// three of them. At the ends the mean is over what there is.
std::vector<double> smooth_gaussian(std::span<const double> values, double sigma);

} // namespace octascope::pipeline
