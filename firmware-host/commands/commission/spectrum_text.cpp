#include "firmware-host/commands/commission/spectrum_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "firmware-host/commands/line_plot.h"

namespace octascope::firmware_host {

namespace {

// Of the brightest sample, as a share of full scale.
constexpr double darkest = 0.4;
constexpr double lightest = 0.8;

} // namespace

std::string spectrum_strip(std::span<const double> line, double highest) {
  static constexpr std::array<std::string_view, 9> heights{" ", "▁", "▂", "▃", "▄",
                                                           "▅", "▆", "▇", "█"};
  constexpr std::size_t letters = 24;
  std::string strip;
  for (std::size_t i = 0; i < letters; ++i) {
    const std::size_t first = line.size() * i / letters;
    const std::size_t end = std::max(line.size() * (i + 1) / letters, first + 1);
    double sum = 0;
    for (std::size_t p = first; p < end && p < line.size(); ++p)
      sum += line[p];
    const double share = sum / static_cast<double>(end - first) / highest;
    const auto step = std::clamp(std::lround(share * 8), 0L, 8L);
    strip += heights[static_cast<std::size_t>(step)];
  }
  return strip;
}

void add_quality(StepRecord& record, const LiveLook& look) {
  const pipeline::SpectrumQuality& quality = look.quality;
  record.found.emplace_back("saturated lines",
                            fmt::format("{:.1f} %", quality.saturated_share * 100));
  record.found.emplace_back("brightest sample", brightness_text(look));
  record.found.emplace_back(
      "dark level",
      fmt::format("{:.0f} counts, where the spectrum is darkest", quality.dark_counts));
  record.found.emplace_back("fringe contrast", fmt::format("{:.1f} % of the light, noise included",
                                                           quality.contrast * 100));
  record.found.emplace_back("frames", fmt::format("{} of {}, {} lost, {} broken", look.frames,
                                                  look.expected_frames, look.lost_frames,
                                                  look.broken_frames));
  if (quality.saturated_share > 0)
    record.warnings.push_back(
        fmt::format("{:.1f} % of the lines are saturated: less light, or a shorter exposure",
                    quality.saturated_share * 100));
  if (quality.brightest < darkest || quality.brightest > lightest)
    record.warnings.push_back(fmt::format(
        "the brightest sample is {:.1f} % of full scale, expected {:.0f} to {:.0f} %: {}",
        quality.brightest * 100, darkest * 100, lightest * 100,
        quality.brightest < darkest ? "more light from the reference arm, or a longer exposure"
                                    : "less light, or a shorter exposure"));
  if (look.lost_frames + look.broken_frames > 0)
    record.warnings.push_back("frames were lost or broken: see the cable, and whether another "
                              "program keeps the machine busy");
}

std::vector<ui::SpectrumFigure> figures_of(const LiveLook& look) {
  const pipeline::SpectrumQuality& quality = look.quality;
  const auto unless = [](bool good, const char* remedy) { return good ? "" : remedy; };
  return {{"Brightest sample", fmt::format("{:.0f} % full", quality.brightest * 100), "40 to 80 %",
           quality.brightest > lightest
               ? "less light, shorter exposure"
               : unless(quality.brightest >= darkest, "more light, longer exposure")},
          {"Saturated lines", fmt::format("{:.1f} %", quality.saturated_share * 100), "0 %",
           unless(quality.saturated_share == 0, "less light, shorter exposure")},
          {"Fringe contrast", fmt::format("{:.1f} %", quality.contrast * 100),
           "5 % and more, with a mirror",
           unless(quality.contrast >= least_mirror_contrast, "see overlap, polarisation, depth")},
          {"Dark level",
           fmt::format("{:.0f} of {} counts", quality.dark_counts, look.format.full_scale()),
           "the camera's own offset"},
          {"Frames lost, broken",
           fmt::format("{}, {} of {}", look.lost_frames, look.broken_frames, look.expected_frames),
           "0, 0",
           unless(look.lost_frames + look.broken_frames == 0, "see cable and other programs")}};
}

void warn_of_contrast(StepRecord& record, const pipeline::SpectrumQuality& quality) {
  if (quality.contrast < least_mirror_contrast)
    record.warnings.push_back(fmt::format(
        "the fringe's contrast is {:.1f} %, expected {:.0f} % or more with a mirror: do "
        "the arms overlap, is the polarisation right, is the mirror within the depth "
        "range?",
        quality.contrast * 100, least_mirror_contrast * 100));
}

std::string brightness_text(const LiveLook& look) {
  const double full = look.format.full_scale();
  return fmt::format("{:.0f} % of full scale ({:.0f} of {:.0f} counts)",
                     look.quality.brightest * 100, look.quality.brightest * full, full);
}

pipeline::Image draw_spectrum(const std::vector<double>& mean, const std::vector<double>& one,
                              double full_scale) {
  constexpr int width = 900;
  constexpr int height = 340;
  pipeline::Image image{width, height, 3};
  std::ranges::fill(image.pixels, std::uint8_t{255});
  PlotPanel panel{"SPECTRUM (COUNTS) OVER PIXEL",       {}, 1,
                  static_cast<double>(mean.size() - 1), 0,  full_scale};
  if (!one.empty())
    panel.curves.push_back({one, {160, 190, 220}, "ONE LINE"});
  panel.curves.push_back({mean, {20, 60, 120}, "MEAN"});
  draw_panel(image, {0, 0, width, height}, panel);
  return image;
}

} // namespace octascope::firmware_host
