#include "firmware-host/commands/vessels/vessels_flight_bench.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/bench/bench_timing.h"
#include "firmware-host/commands/vessels/vessel_text.h"
#include "ui/vessels/view/vessel_flight.h"

namespace octascope::firmware_host {

namespace {

constexpr float step_px = 0.5F;

class FlightBench {
public:
  FlightBench(VesselsBenchPainter& painter, ui::VesselMethod& hybrid, ui::VesselMethod& quads)
      : painter_{painter}, hybrid_{hybrid}, quads_{quads} {}

  hal::Result<> warm_up(const ui::VesselView& view) {
    const auto drawn = painter_.draw(hybrid_, view);
    return drawn ? hal::Result<>{} : tl::make_unexpected(drawn.error());
  }

  hal::Result<> visit(const std::array<ui::VesselView, 2>& views) {
    std::array<pipeline::Image, 2> shown;
    std::array<pipeline::Image, 2> full;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const auto begin = BenchClock::now();
      HAL_CHECK(painter_.draw(hybrid_, views[i]));
      ms_.push_back(1000 * seconds_since(begin));
      shown[i] = painter_.read();
      HAL_TRY(auto expected, painter_.picture(quads_, views[i]));
      full[i] = std::move(expected);
      raise(report_.worst_difference, mean_difference(shown[i], full[i]));
    }
    const double step = mean_difference(shown[0], shown[1]);
    const double quads_step = mean_difference(full[0], full[1]);
    raise(report_.worst_step, step);
    raise(report_.worst_quads_step, quads_step);
    raise(report_.worst_beyond, step - quads_step);
    ++report_.places;
    return {};
  }

  VesselsFlightReport finish() {
    report_.ms_p50 = quantile(ms_, 0.5);
    report_.ms_p95 = quantile(ms_, 0.95);
    return report_;
  }

private:
  static void raise(double& most, double value) { most = std::max(most, value); }

  VesselsBenchPainter& painter_;
  ui::VesselMethod& hybrid_;
  ui::VesselMethod& quads_;
  VesselsFlightReport report_;
  std::vector<double> ms_;
};

} // namespace

hal::Result<VesselsFlightReport>
bench_flight(VesselsBenchPainter& painter, ui::VesselMethod& hybrid, ui::VesselMethod& quads,
             int places, const std::function<void(std::string_view)>& progress) {
  const ui::VesselFlight flight{painter.tree(), painter.width(), painter.height()};
  const float step = step_px / flight.pixels();
  FlightBench bench{painter, hybrid, quads};
  HAL_CHECK(bench.warm_up(flight.at(0)));
  for (int i = 0; i < places; ++i) {
    const float t =
        (1 - step) * static_cast<float>(i) / static_cast<float>(std::max(1, places - 1));
    HAL_CHECK(bench.visit({flight.at(t), flight.at(t + step)}));
    if (progress)
      progress(fmt::format("flight {} of {}: {}", i + 1, places, describe(flight.at(t))));
  }
  VesselsFlightReport report = bench.finish();
  report.length_mm = static_cast<double>(flight.length_mm());
  return report;
}

} // namespace octascope::firmware_host
