#include "ui/dither/soften.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::ui {

namespace {

static_assert(soften_radius == 1);
constexpr int chunk = 256; // pixels at a time
constexpr std::size_t channels = 4;

using Sums = std::array<std::uint16_t, channels*(chunk + 2)>;

OCTASCOPE_CPU_CLONES
void add_rows(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
              std::uint16_t* __restrict sums, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    sums[i] = static_cast<std::uint16_t>(above[i] + 2 * here[i] + below[i]);
}

OCTASCOPE_CPU_CLONES
void average_columns(const std::uint16_t* sums, std::uint8_t* __restrict to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = static_cast<std::uint8_t>(
        (sums[i] + 2 * sums[i + channels] + sums[i + 2 * channels] + 8) >> 4);
}

std::size_t at(const SoftenJob& job, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(job.width) +
         static_cast<std::size_t>(x);
}

std::uint32_t average_of_alike(const SoftenJob& job, int x, int y) {
  const auto stopped = [&](std::size_t i) { return job.stops->pixels[i] != empty_depth_pixel; };
  const bool here = stopped(at(job, x, y));
  std::array<std::uint32_t, channels> sums{};
  std::uint32_t count = 0;
  for (int row = std::max(y - 1, job.drawn.y); row <= std::min(y + 1, job.drawn.bottom() - 1);
       ++row)
    for (int column = std::max(x - 1, job.drawn.x);
         column <= std::min(x + 1, job.drawn.right() - 1); ++column) {
      const std::size_t i = at(job, column, row);
      if (stopped(i) != here)
        continue;
      const std::uint32_t weight = (row == y ? 2U : 1U) * (column == x ? 2U : 1U);
      count += weight;
      for (std::size_t channel = 0; channel < channels; ++channel)
        sums[channel] += weight * (job.from[i] >> (8 * channel) & 0xFFU);
    }
  std::uint32_t rgba = 0;
  for (std::size_t channel = 0; channel < channels; ++channel)
    rgba |= (sums[channel] + count / 2) / count << (8 * channel);
  return rgba;
}

// Whether a vessel is within reach of a pixel of the row's part.
bool near_vessels(const SoftenJob& job, int left, int right, int y) {
  for (int row = std::max(y - 1, job.drawn.y); row <= std::min(y + 1, job.drawn.bottom() - 1);
       ++row)
    for (int x = std::max(left - 1, job.drawn.x); x < std::min(right + 1, job.drawn.right()); ++x)
      if (job.stops->pixels[at(job, x, row)] != empty_depth_pixel)
        return true;
  return false;
}

void soften_chunk(const SoftenJob& job, int left, int right, int y) {
  if (job.stops != nullptr && near_vessels(job, left, right, y)) {
    for (int x = left; x < right; ++x)
      job.to[at(job, x, y)] = average_of_alike(job, x, y);
    return;
  }
  Sums sums;
  const auto row = [&](int of, int x) {
    const int inside = std::clamp(of, job.drawn.y, job.drawn.bottom() - 1);
    return reinterpret_cast<const std::uint8_t*>(job.from.data() + at(job, x, inside));
  };
  const auto add = [&](int x, int count, std::size_t to) {
    add_rows(row(y - 1, x), row(y, x), row(y + 1, x), sums.data() + channels * to,
             channels * static_cast<std::size_t>(count));
  };
  const int count = right - left;
  add(std::max(left - 1, job.drawn.x), 1, 0);
  add(left, count, 1);
  add(std::min(right, job.drawn.right() - 1), 1, static_cast<std::size_t>(count) + 1);
  average_columns(sums.data(), reinterpret_cast<std::uint8_t*>(job.to.data() + at(job, left, y)),
                  channels * static_cast<std::size_t>(count));
}

} // namespace

void soften_rows(const SoftenJob& job, int first, int last) {
  for (int y = std::max(first, job.drawn.y); y < std::min(last, job.drawn.bottom()); ++y)
    for (int left = job.drawn.x; left < job.drawn.right(); left += chunk)
      soften_chunk(job, left, std::min(left + chunk, job.drawn.right()), y);
}

} // namespace octascope::ui
