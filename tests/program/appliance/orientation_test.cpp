// From raw spectra to pixels: what is at the left, above and in front in the patient is there on
// the glass, and as long as the scale bars say. One block of tissue in one corner of the scan, as
// the camera would deliver it, goes through the whole program.
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/volume/volume_geometry.h"
#include "tests/program/program_support.h"
#include "ui/hud/hud.h"
#include "ui/view/camera.h"

namespace octascope::tests {
namespace {

constexpr int samples = 128;
constexpr pipeline::VolumeGeometry field{samples / 2, 40, 24, 20, 25, 50}; // 1.28 × 1.0 × 1.2 mm

// The block: shallow, the first A-scans, the first B-scans, the middle one included.
constexpr int block_depth_from = 8, block_depth_until = 20;
constexpr int block_a_scans = 10, block_b_scans = 15;

// As shares of the field's depth, A-scans and B-scans.
using Place = std::array<double, 3>;
constexpr Place block_centre{(block_depth_from + block_depth_until) / 2.0 / field.depths,
                             block_a_scans / 2.0 / field.a_scans,
                             block_b_scans / 2.0 / field.b_scans};

// Interference of reflectors with the reference arm: a cosine a depth, of different phases so that
// they do not add up to a flash in the middle of the spectrum.
std::vector<std::uint16_t> spectra() {
  std::vector<std::uint16_t> counts;
  for (int b = 0; b < field.b_scans; ++b)
    for (int a = 0; a < field.a_scans; ++a)
      for (int m = 0; m < samples; ++m) {
        double count = 2000;
        if (a < block_a_scans && b < block_b_scans)
          for (int z = block_depth_from; z < block_depth_until; ++z)
            count += 120 * std::cos(2 * std::numbers::pi * z * m / samples + 1.7 * z * z);
        counts.push_back(static_cast<std::uint16_t>(std::lround(count)));
      }
  return counts;
}

class Orientation : public testing::Test {
protected:
  // What both commands take: the recording and how it was made.
  std::vector<std::string> recording() {
    const auto raw = folder_.write_values<std::uint16_t>("spectra.raw", spectra());
    const auto calibration = folder_.write(
        "calibration.toml",
        fmt::format("[spectrometer]\nsamples = {}\n[k_linear]\npolynomial = [0.0, {}.0]\n"
                    "interpolation = \"linear\"\n[background]\nmode = \"none\"\n[window]\n"
                    "kind = \"hann\"\n[depth]\nspacing_um = {}\na_spacing_um = {}\n"
                    "b_spacing_um = {}\n",
                    samples, samples - 1, field.depth_spacing_um, field.a_spacing_um,
                    field.b_spacing_um));
    return {"--spectra",     raw,
            "--shape",       fmt::format("{},{},{}", field.b_scans, field.a_scans, samples),
            "--calibration", calibration};
  }

  // The last picture of a live run, with the whole scan and not only the tissue in the flat
  // pictures: zoom_to_tissue, eleven functions on, is turned off at the start.
  pipeline::Image live(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{
        "run",
        "--display",
        "offscreen",
        "--size",
        "1280x720",
        "--volumes",
        "3",
        "--snapshot",
        folder_ / "live.png",
        "--controls",
        folder_.write("whole_scan.toml", "event = [ { time_s = 0.1, switch = 0, value = 1 },\n"
                                         "  { time_s = 0.2, knob = 0, value = 11 },\n"
                                         "  { time_s = 0.25, switch = 0, value = 0 },\n"
                                         "  { time_s = 0.4, knob = 0, value = -1 } ]\n"),
        "--config",
        folder_.write("slow.toml", "[scan]\nline_rate_hz = 4800\n[display]\nwindow_offset_db = 10\n"
                                   "window_size_db = 20\nopacity = 0.9\n")};
    for (const auto& part : {recording(), more})
      words.insert(words.end(), part.begin(), part.end());
    run_well(words);
    return read_snapshot(folder_ / "live.png");
  }

  static ui::Layout layout(const pipeline::Image& picture) {
    return ui::lay_out(picture.width, picture.height,
                       {.b_scan = field.a_mm() / field.depth_mm(),
                        .en_face = field.a_mm() / field.b_mm(),
                        .has_scope = false,
                        .crossed = field.b_mm() / field.depth_mm()});
  }

  // Mean grey of a small square about a place in a rectangle, given in shares of it.
  static double grey_at(const pipeline::Image& picture, const ui::Rect& rect, double x, double y) {
    const int column = rect.x + static_cast<int>(std::lround(x * rect.width));
    const int row = rect.y + static_cast<int>(std::lround(y * rect.height));
    double sum = 0;
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        sum += picture.pixel(column + dx, row + dy)[1];
    return sum / 25;
  }

  ScratchFolder folder_;
};

// The place mirrored along the axes whose bits are set.
Place mirrored(Place place, unsigned axes) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((axes >> axis & 1U) != 0)
      place[axis] = 1 - place[axis];
  return place;
}

TEST_F(Orientation, the_b_scan_has_the_first_a_scans_left_and_the_surface_above) {
  const pipeline::Image picture = live();
  const ui::Rect b_scan = layout(picture).b_scan.picture;
  ASSERT_GT(b_scan.width, 100);
  const auto grey = [&](unsigned axes) {
    const Place p = mirrored({block_centre[0], 0.2, block_centre[2]}, axes); // beside the ruler
    return grey_at(picture, b_scan, p[1], p[0]);
  };
  EXPECT_GT(grey(0), 100);
  EXPECT_LT(grey(1), 40) << "upside down";
  EXPECT_LT(grey(2), 40) << "left and right changed";
  EXPECT_LT(grey(3), 40) << "turned";
}

TEST_F(Orientation, the_en_face_has_the_first_a_scans_left_and_the_first_b_scans_above) {
  const pipeline::Image picture = live();
  const ui::Rect en_face = layout(picture).en_face.picture;
  ASSERT_GT(en_face.width, 100);
  const auto grey = [&](double a, double b) { return grey_at(picture, en_face, a, b); };
  constexpr double left = 0.12, right = 0.88, above = 0.2, below = 0.85;
  EXPECT_GT(grey(left, above), 100);
  EXPECT_LT(grey(left, below), 60) << "the first B-scans are below";
  EXPECT_LT(grey(right, above), 60) << "the first A-scans are at the right";
  EXPECT_LT(grey(right, below), 60);
}

// Seen as it is first shown, obliquely: of the block's eight mirror images its own place alone is
// bright.
TEST_F(Orientation, the_volume_has_the_block_in_its_corner) {
  const pipeline::Image picture = live();
  const ui::Rect view = layout(picture).view;
  const double aspect = static_cast<double>(view.width) / view.height;
  const ui::Camera camera =
      ui::make_camera(ui::ViewState{}, ui::box_extents_mm(field), static_cast<float>(aspect));
  const auto grey = [&](unsigned axes) {
    const Place p = mirrored({block_centre[0], block_centre[1], 0.1}, axes);
    const glm::vec2 at = camera.project({static_cast<float>((p[1] - 0.5) * field.a_mm()),
                                         static_cast<float>((0.5 - p[0]) * field.depth_mm()),
                                         static_cast<float>((p[2] - 0.5) * field.b_mm())});
    return grey_at(picture, view, 0.5 + double{at.x} / aspect, 0.5 + double{at.y});
  };
  EXPECT_GT(grey(0), 60);
  for (const unsigned axes : {1U, 2U, 3U, 4U, 5U, 6U, 7U})
    EXPECT_LT(grey(axes), grey(0) / 2) << "mirrored along " << axes;
}

// ---- How long things are.

// Columns of a row that are lit, from the first to the last. At the right of B-scans is a ruler.
int lit_width(const pipeline::Image& picture, const ui::Rect& row, int least) {
  int first = -1;
  int last = -2;
  for (int x = row.x; x < row.right(); ++x) {
    if (picture.pixel(x, row.y)[1] < least)
      continue;
    first = first < 0 ? x : first;
    last = x;
  }
  return last - first + 1;
}

TEST_F(Orientation, the_scale_bar_of_the_b_scan_is_as_long_as_it_says) {
  const pipeline::Image picture = live();
  const ui::Layout places = layout(picture);
  const ui::Rect b_scan = places.b_scan.picture;
  const int block_px = lit_width(
      picture,
      {b_scan.x, b_scan.y + static_cast<int>(block_centre[0] * b_scan.height), b_scan.width / 2, 1},
      90);
  const int bar_px = lit_width(
      picture,
      {b_scan.x, b_scan.bottom() - static_cast<int>(10 * places.unit), b_scan.width / 2, 1}, 180);
  ASSERT_GT(block_px, 20);
  ASSERT_GT(bar_px, 20);
  const double mm_per_pixel = block_a_scans * field.a_spacing_um / 1000 / block_px;
  const double bar_mm = bar_px * mm_per_pixel;
  // 1, 2 or 5 of a power of ten, and nothing between.
  const double said_mm = ui::round_scale_length_mm(bar_mm * 1.1);
  EXPECT_NEAR(bar_mm, said_mm, 0.08 * said_mm)
      << block_px << " px of block, " << bar_px << " of bar";
}

// Width and depth have the same scale, that of the picture's physical shape: what is known to be so
// far from the corner is there.
TEST_F(Orientation, the_b_scan_is_drawn_in_its_physical_shape) {
  const pipeline::Image picture = live();
  const ui::Rect b_scan = layout(picture).b_scan.picture;
  EXPECT_NEAR(static_cast<double>(b_scan.width) / b_scan.height, field.a_mm() / field.depth_mm(),
              0.01);
  const int row = b_scan.y + static_cast<int>(block_centre[0] * b_scan.height);
  const int right_edge = lit_width(picture, {b_scan.x, row, b_scan.width / 2, 1}, 90);
  EXPECT_NEAR(right_edge, b_scan.width * block_a_scans / field.a_scans, 2);
  const int column = b_scan.x + static_cast<int>(block_centre[1] * b_scan.width);
  int lit = 0;
  double sum = 0;
  // Above lies what the spectrum's mean leaves at zero delay, below the scale bar.
  for (int y = b_scan.y + b_scan.height / 16; y < b_scan.y + b_scan.height / 2; ++y) {
    if (picture.pixel(column, y)[1] >= 90) {
      ++lit;
      sum += y - b_scan.y;
    }
  }
  ASSERT_GT(lit, 10);
  EXPECT_NEAR(sum / lit, block_centre[0] * b_scan.height, 3);
}

} // namespace
} // namespace octascope::tests
