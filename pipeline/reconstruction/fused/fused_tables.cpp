#include "pipeline/reconstruction/fused/fused_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>

namespace octascope::pipeline {

namespace {

constexpr int shortest_line = 256;
constexpr int longest_line = 8192;

std::size_t index(int value) {
  return static_cast<std::size_t>(value);
}

std::complex<double> unit_root(double numerator, double denominator) {
  return std::polar(1.0, -2 * std::numbers::pi * numerator / denominator);
}

void append(AlignedVector<float>& table, std::complex<double> value) {
  table.push_back(static_cast<float>(value.real()));
  table.push_back(static_cast<float>(value.imag()));
}

// Taps of one sample without the zeros at their ends.
struct Support {
  int first;
  int width;
};

Support support_of(const ResamplingTaps& taps, std::size_t m) {
  const auto width = index(taps.width);
  std::size_t from = 0;
  std::size_t to = width;
  while (from + 1 < width && taps.weights[m * width + from] == 0)
    ++from;
  while (to > from + 1 && taps.weights[m * width + to - 1] == 0)
    --to;
  return {taps.first[m] + static_cast<int>(from), static_cast<int>(to - from)};
}

// Q14, with the rounding errors put on the largest weight so that the sum stays what it is.
void quantise(std::span<std::int16_t> fixed, std::span<const double> weights) {
  constexpr double one = 1 << weight_bits;
  double sum = 0;
  int fixed_sum = 0;
  std::size_t largest = 0;
  for (std::size_t t = 0; t < weights.size(); ++t) {
    fixed[t] = static_cast<std::int16_t>(std::lround(weights[t] * one));
    fixed_sum += fixed[t];
    sum += weights[t];
    largest = std::abs(weights[t]) > std::abs(weights[largest]) ? t : largest;
  }
  fixed[largest] = static_cast<std::int16_t>(fixed[largest] +
                                             static_cast<int>(std::lround(sum * one)) - fixed_sum);
}

void make_taps(FusedTables& tables, const Calibration& calibration) {
  const int samples = tables.samples;
  ResamplingTaps taps = make_resampling_taps(calibration.positions, calibration.interpolation);
  if (taps.width == 0) { // every position is its own pixel
    taps.width = 1;
    taps.weights.assign(index(samples), 1.0F);
    for (int m = 0; m < samples; ++m)
      taps.first.push_back(m);
  }
  int widest = 0;
  for (int m = 0; m < samples; ++m)
    widest = std::max(widest, support_of(taps, index(m)).width);
  tables.tap_pairs = widest <= 2 ? 1 : widest <= 4 ? 2 : 4;
  const int width = 2 * tables.tap_pairs;
  tables.tap_weights.assign(index(samples * width), 0);
  std::vector<double> weights;
  for (int m = 0; m < samples; ++m) {
    const Support support = support_of(taps, index(m));
    const int first = std::min(support.first, samples - width);
    weights.assign(index(width), 0.0);
    for (int t = 0; t < support.width; ++t)
      weights[index(support.first + t - first)] = static_cast<double>(
          taps.weights[index(m * taps.width + support.first + t - taps.first[index(m)])]);
    tables.tap_starts.push_back(first);
    quantise(std::span{tables.tap_weights}.subspan(index(m * width), index(width)), weights);
  }
}

// The windows of one block that begins at sample m; false where one does not reach far enough.
bool append_windows(FusedTables& tables, const WindowShape& shape, int m) {
  const int width = 2 * tables.tap_pairs;
  const int moved = tables.one_window ? 0 : width - 2; // by the last pair
  const int held = tables.one_window ? width : 2;      // taps in a window
  for (int group = m; group < m + shape.lanes; group += shape.outputs) {
    const auto first = tables.tap_starts.begin() + group;
    // The last pair's window must end with the line.
    const int start = std::min(*std::min_element(first, first + shape.outputs),
                               tables.samples - shape.samples - moved);
    tables.window_starts.push_back(start);
    for (int i = 0; i < shape.outputs; ++i) {
      const int offset = first[i] - start;
      if (offset < 0 || offset + held > shape.samples)
        return false;
      for (const int sample : {offset, offset + 1}) {
        const int low = shape.byte_indices ? 2 * sample : sample;
        const int high = shape.byte_indices ? 2 * sample + 1 : 0;
        tables.permutations.push_back(static_cast<std::uint8_t>(low));
        tables.permutations.push_back(static_cast<std::uint8_t>(high));
      }
    }
  }
  return true;
}

bool append_block(FusedTables& tables, const Calibration& calibration, const WindowShape& shape,
                  int m) {
  if (!append_windows(tables, shape, m))
    return false;
  const int width = 2 * tables.tap_pairs;
  for (int pair = 0; pair < tables.tap_pairs; ++pair)
    for (int lane = 0; lane < shape.lanes; ++lane)
      for (int t = 0; t < 2; ++t)
        tables.weights.push_back(tables.tap_weights[index((m + lane) * width + 2 * pair + t)]);
  std::vector<double> imaginary;
  for (int lane = 0; lane < shape.lanes; ++lane) {
    const auto sample = index(m + lane);
    const double theta = tables.real_input ? 0 : calibration.dispersion_rad[sample];
    const double weight = calibration.window[sample] / tables.samples / (1 << weight_bits);
    tables.factors.push_back(static_cast<float>(weight * std::cos(theta)));
    imaginary.push_back(weight * std::sin(theta));
  }
  if (!tables.real_input)
    for (const double value : imaginary)
      tables.factors.push_back(static_cast<float>(value));
  return true;
}

bool append_blocks(FusedTables& tables, const Calibration& calibration, const WindowShape& shape) {
  const int step = tables.blocks / first_radix;
  std::int32_t place = 0;
  tables.window_starts.clear();
  tables.permutations.clear();
  tables.weights.clear();
  tables.factors.clear();
  for (int j = 0; j < step; ++j)
    for (int a = 0; a < first_radix; ++a) {
      const int m = (j + a * step) * shape.lanes;
      if (!append_block(tables, calibration, shape, m))
        return false;
      for (int lane = 0; lane < shape.lanes; ++lane)
        tables.block_of[index(m + lane)] = place++;
    }
  return true;
}

// With one window for all pairs of taps where every block's is wide enough.
bool append_all(FusedTables& tables, const Calibration& calibration, const WindowShape& shape) {
  tables.one_window = !shape.byte_indices; // permutations by bytes cannot reach beyond their part
  if (tables.one_window && append_blocks(tables, calibration, shape))
    return true;
  tables.one_window = false;
  return append_blocks(tables, calibration, shape);
}

// J = 8·4^i·8^j with as few passes as possible, an eight last where there is one: every J of the
// supported lines has such radices.
void choose_radices(FusedTables& tables) {
  int bits = std::countr_zero(static_cast<unsigned>(tables.blocks / first_radix));
  tables.radices[index(tables.passes++)] = first_radix;
  while (bits > 0) {
    const bool four = bits % 3 != 0;
    tables.radices[index(tables.passes++)] = four ? 4 : 8;
    bits -= four ? 2 : 3;
  }
}

void make_pass_twiddles(FusedTables& tables) {
  int size = tables.blocks;
  for (int pass = 0; pass + 1 < tables.passes; ++pass) {
    const int radix = tables.radices[index(pass)];
    for (int j = 0; j < size / radix; ++j)
      for (int q = 1; q < radix; ++q)
        append(tables.pass_twiddles[index(pass)], unit_root(static_cast<double>(j) * q, size));
    size /= radix;
  }
}

// The groups of the last pass lie in the order of their digits, the first pass' output being the
// most significant; in the bins it is the least.
void make_last_rows(FusedTables& tables) {
  const int groups = tables.blocks / tables.last_radix();
  for (int group = 0; group < groups; ++group) {
    int remainder = group;
    int weight = groups;
    int row = 0;
    int scale = 1;
    for (int pass = 0; pass + 1 < tables.passes; ++pass) {
      weight /= tables.radices[index(pass)];
      row += remainder / weight * scale;
      remainder %= weight;
      scale *= tables.radices[index(pass)];
    }
    tables.last_rows.push_back(row);
  }
}

void append_turns(AlignedVector<float>& table, int lanes, const auto& turn) {
  for (const bool imaginary : {false, true})
    for (int lane = 0; lane < lanes; ++lane) {
      const std::complex<double> root = turn(lane);
      table.push_back(static_cast<float>(imaginary ? root.imag() : root.real()));
    }
}

void make_lane_twiddles(FusedTables& tables) {
  const int rows = tables.blocks / tables.last_radix();
  for (const int row : tables.last_rows)
    for (int t = 0; t < tables.last_radix(); ++t)
      append_turns(tables.last_twiddles, tables.lanes, [&](int lane) {
        return unit_root(static_cast<double>(lane) * (row + rows * t), tables.samples);
      });
  for (int v = 1; v < tables.lanes / 4; ++v)
    append_turns(tables.lane_twiddles, tables.lanes,
                 [&](int lane) { return unit_root(lane % 4 * v, tables.lanes); });
}

// The bin less its row of lane 4·part + i in output register u of one group of four results.
int bin_offset(const FusedTables& tables, int group, int u, int part, int i) {
  const int parts = tables.lanes / 4;
  // Which of the four results, and which v: see lane_transform() in fused_lanes_inl.h.
  const int result = parts == 4 ? part : parts == 2 ? i / 2 * 2 + part : i;
  const int v = parts == 4 ? i : parts == 2 ? i % 2 : 0;
  const int rows = tables.blocks / tables.last_radix();
  return rows * (4 * group + result) + tables.blocks * (v + parts * u);
}

void make_offsets(FusedTables& tables) {
  const int parts = tables.lanes / 4;
  for (int group = 0; group < tables.last_radix() / 4; ++group) {
    for (int part = 0; part < parts; ++part) // bytes: packed four by four
      for (int u = 0; u < 2; ++u)
        for (int i = 0; i < 4; ++i)
          tables.offsets_u8.push_back(bin_offset(tables, group, u, part, i));
    for (int u = 0; u < 2; ++u) // floats: register by register
      for (int lane = 0; lane < tables.lanes; ++lane)
        tables.offsets_db.push_back(bin_offset(tables, group, u, lane / 4, lane % 4));
  }
}

} // namespace

std::optional<FusedTables> make_fused_tables(const Calibration& calibration, int right_shift,
                                             const WindowShape& shape) {
  const int samples = calibration.samples;
  if (samples < shortest_line || samples > longest_line ||
      !std::has_single_bit(static_cast<unsigned>(samples)) || samples < fewest_blocks * shape.lanes)
    return std::nullopt;
  FusedTables tables;
  tables.samples = samples;
  tables.lanes = shape.lanes;
  tables.blocks = samples / shape.lanes;
  tables.right_shift = right_shift;
  tables.real_input = calibration.dispersion_rad.empty();
  make_taps(tables, calibration);
  tables.block_of.resize(index(samples));
  if (!append_all(tables, calibration, shape))
    return std::nullopt;
  choose_radices(tables);
  make_pass_twiddles(tables);
  make_last_rows(tables);
  make_lane_twiddles(tables);
  make_offsets(tables);
  return tables;
}

} // namespace octascope::pipeline
