// Gaussian moving average.
#pragma once

#include <span>
#include <vector>

namespace octascope::pipeline {

// Weighted mean around each value with standard deviation `sigma` in samples, cut off at 3 sigma.
// At the ends the mean is over the values that exist.
std::vector<double> smooth_gaussian(std::span<const double> values, double sigma);

} // namespace octascope::pipeline
