#include "tests/ui/support/structural_similarity.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace octascope::tests {

namespace {

constexpr int side = 11;
constexpr double deviation = 1.5;
constexpr double c1 = (0.01 * 255) * (0.01 * 255);
constexpr double c2 = (0.03 * 255) * (0.03 * 255);
constexpr double structureless = 1; // variance, of 255 squared

std::array<double, side> gaussian() {
  std::array<double, side> weights{};
  double sum = 0;
  for (int i = 0; i < side; ++i) {
    const double x = i - side / 2;
    sum += weights[static_cast<std::size_t>(i)] = std::exp(-x * x / (2 * deviation * deviation));
  }
  for (double& weight : weights)
    weight /= sum;
  return weights;
}

std::vector<double> luminance(const pipeline::Image& image) {
  std::vector<double> grey(image.pixels.size() / 3);
  for (std::size_t i = 0; i < grey.size(); ++i)
    grey[i] = 0.299 * image.pixels[3 * i] + 0.587 * image.pixels[3 * i + 1] +
              0.114 * image.pixels[3 * i + 2];
  return grey;
}

std::vector<double> product(std::span<const double> a, std::span<const double> b) {
  std::vector<double> result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    result[i] = a[i] * b[i];
  return result;
}

// Weighted means of the windows that lie wholly in the picture, row by row.
std::vector<double> window_means(std::span<const double> values, std::size_t width,
                                 std::size_t height) {
  const std::array<double, side> weights = gaussian();
  const std::size_t columns = width - side + 1;
  const std::size_t rows = height - side + 1;
  std::vector<double> along(columns * height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < columns; ++x)
      for (std::size_t i = 0; i < side; ++i)
        along[y * columns + x] += weights[i] * values[y * width + x + i];
  std::vector<double> means(columns * rows);
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x)
      for (std::size_t i = 0; i < side; ++i)
        means[y * columns + x] += weights[i] * along[(y + i) * columns + x];
  return means;
}

} // namespace

double structural_similarity(const pipeline::Image& a, const pipeline::Image& b) {
  const auto width = static_cast<std::size_t>(a.width);
  const auto height = static_cast<std::size_t>(a.height);
  if (a.channels != 3 || b.channels != 3 || a.width != b.width || a.height != b.height ||
      a.width < side || a.height < side)
    return 0;
  const std::vector<double> x = luminance(a);
  const std::vector<double> y = luminance(b);
  const auto mean_x = window_means(x, width, height);
  const auto mean_y = window_means(y, width, height);
  const auto mean_xx = window_means(product(x, x), width, height);
  const auto mean_yy = window_means(product(y, y), width, height);
  const auto mean_xy = window_means(product(x, y), width, height);
  double all = 0;
  double structured = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mean_x.size(); ++i) {
    const double variance_x = mean_xx[i] - mean_x[i] * mean_x[i];
    const double variance_y = mean_yy[i] - mean_y[i] * mean_y[i];
    const double covariance = mean_xy[i] - mean_x[i] * mean_y[i];
    const double similarity =
        (2 * mean_x[i] * mean_y[i] + c1) * (2 * covariance + c2) /
        ((mean_x[i] * mean_x[i] + mean_y[i] * mean_y[i] + c1) * (variance_x + variance_y + c2));
    all += similarity;
    if (variance_x > structureless || variance_y > structureless) {
      structured += similarity;
      ++count;
    }
  }
  return count > 0 ? structured / static_cast<double>(count)
                   : all / static_cast<double>(mean_x.size());
}

} // namespace octascope::tests
