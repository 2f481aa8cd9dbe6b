#include "firmware-host/commands/vessels/vessels_bench.h"

#include <algorithm>
#include <array>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/commands/bench/bench_timing.h"
#include "firmware-host/commands/offscreen_gl.h"
#include "firmware-host/commands/vessels/vessel_text.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "pipeline/files/png_image.h"
#include "ui/gl/context_info.h"
#include "ui/gl/framebuffer.h"

namespace octascope::firmware_host {

namespace {

constexpr float turn_deg = 0.05F; // from frame to frame
constexpr int fewest_frames = 3;
constexpr double turn_seconds = 0.4; // how long a method is measured before the next has its turn
constexpr double slow_seconds = 15;  // of a frame: it is not drawn a second time
// Within a pixel, in pixels.
constexpr std::array<std::array<float, 2>, 4> sample_places{
    {{-0.125F, -0.375F}, {0.375F, -0.125F}, {0.125F, 0.375F}, {-0.375F, 0.125F}}};

hal::Result<> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error)
    return {};
  return hal::fail(hal::ErrorCode::system,
                   "{}: cannot be made: {}; choose a folder that you may write to", folder.string(),
                   error.message());
}

// One method in one view.
struct Measured {
  const VesselBenchMethod* what = nullptr;
  ui::VesselMethod* method = nullptr;
  std::vector<double> ms;
  double seconds = 0;
  ui::SegmentCounts account;

  bool done(double wanted_seconds) const {
    const bool slow = !ms.empty() && ms.front() > 1000 * slow_seconds;
    return slow || (static_cast<int>(ms.size()) >= fewest_frames && seconds >= wanted_seconds);
  }
};

class VesselsBench {
public:
  VesselsBench(const pipeline::VesselClusters& tree, const VesselsBenchOptions& options,
               ui::VesselPicture picture)
      : tree_{tree}, options_{options}, painter_{tree, std::move(picture), options.width,
                                                 options.height},
        nodes_{std::make_shared<ui::NodeTexture>()} {}

  hal::Result<> make_methods() {
    for (const VesselBenchMethod& what : vessel_bench_methods()) {
      const bool asked = options_.methods.empty() ||
                         std::ranges::find(options_.methods, what.name) != options_.methods.end();
      if (!asked)
        continue;
      HAL_TRY(auto made, ui::make_vessel_method(what.kind, nodes_, {what.choice, {}, {}}));
      methods_.emplace_back(&what, std::move(made));
    }
    auto made = ui::make_vessel_method(ui::VesselMethodKind::quads_gpu, nodes_);
    if (!made)
      return tl::make_unexpected(made.error());
    quads_ = std::move(*made);
    made = ui::make_vessel_method(ui::VesselMethodKind::quads_gpu, nodes_,
                                  {ui::ClusterChoice::all, {}, {}});
    if (!made)
      return tl::make_unexpected(made.error());
    brute_force_ = std::move(*made);
    return {};
  }

  hal::Result<double> upload_ms() {
    const auto begin = BenchClock::now();
    HAL_CHECK(nodes_->show(tree_));
    ui::gl::finish();
    return 1000 * seconds_since(begin);
  }

  hal::Result<VesselsBenchView> measure(ui::BenchmarkView what) {
    VesselsBenchView result;
    result.what = what;
    result.view = ui::make_benchmark_view(what, tree_, options_.width, options_.height);
    HAL_TRY(const auto quads, painter_.picture(*quads_, result.view));
    HAL_TRY(const auto supersampled, supersampled_quads(result.view));
    HAL_TRY(auto measured, time_methods(result.view));
    for (const Measured& m : measured) {
      HAL_TRY(const auto drawn, painter_.picture(*m.method, result.view, m.what->occluded));
      HAL_CHECK(dump(what, m.what->name, drawn));
      VesselsBenchCase made{m.what->name,
                            static_cast<int>(m.ms.size()),
                            quantile(m.ms, 0.5),
                            quantile(m.ms, 0.95),
                            m.account,
                            mean_difference(drawn, quads),
                            {},
                            {}};
      if (supersampled)
        made.supersampled_difference = mean_difference(drawn, *supersampled);
      if (m.what->kind == ui::VesselMethodKind::balanced)
        made.shares = dynamic_cast<const ui::StreamedQuadsMethod&>(*m.method).shares();
      report(what, made);
      result.cases.push_back(std::move(made));
    }
    return result;
  }

  hal::Result<VesselsFlightReport> fly() {
    HAL_TRY(auto hybrid, ui::make_vessel_method(ui::VesselMethodKind::hybrid, nodes_));
    return bench_flight(painter_, *hybrid, *quads_, options_.flight_places, options_.progress);
  }

private:
  // Nothing where it is not asked for.
  hal::Result<std::optional<pipeline::Image>> supersampled_quads(const ui::VesselView& view) {
    if (!options_.supersampled)
      return std::optional<pipeline::Image>{};
    pipeline::Image mean;
    std::vector<int> sums;
    for (const auto& [right, up] : sample_places) {
      HAL_TRY(auto sample, painter_.picture_beside(*brute_force_, view, right, up));
      sums.resize(sample.pixels.size());
      for (std::size_t i = 0; i < sums.size(); ++i)
        sums[i] += sample.pixels[i];
      mean = std::move(sample);
    }
    constexpr int samples = static_cast<int>(sample_places.size());
    std::ranges::transform(sums, mean.pixels.begin(), [](int sum) {
      return static_cast<std::uint8_t>((sum + samples / 2) / samples);
    });
    return std::optional{std::move(mean)};
  }

  // In turns, so that what else the machine does meets all of them alike.
  hal::Result<std::vector<Measured>> time_methods(const ui::VesselView& view) {
    std::vector<Measured> all;
    for (const auto& [what, method] : methods_)
      all.push_back({what, method.get(), {}, 0, {}});
    for (Measured& m : all)
      HAL_CHECK(warm_up(m, view));
    const auto is_done = [&](const Measured& m) { return m.done(options_.seconds); };
    while (!std::ranges::all_of(all, is_done))
      for (Measured& m : all)
        if (!is_done(m))
          HAL_CHECK(take_turn(m, view));
    return all;
  }

  // A frame that does not count, but where a second one would take too long.
  hal::Result<> warm_up(Measured& m, const ui::VesselView& view) {
    HAL_CHECK(draw_frame(m, view));
    if (!m.done(0) || m.ms.size() > 1)
      m.ms.clear();
    m.seconds = 0;
    return {};
  }

  hal::Result<> take_turn(Measured& m, const ui::VesselView& view) {
    const double until = std::min(m.seconds + turn_seconds, options_.seconds);
    do {
      ui::VesselView turned = view;
      turned.yaw_deg += turn_deg * static_cast<float>(m.ms.size() + 1);
      HAL_CHECK(draw_frame(m, turned));
    } while (m.seconds < until);
    return {};
  }

  hal::Result<> draw_frame(Measured& m, const ui::VesselView& view) {
    const auto begin = BenchClock::now();
    HAL_TRY(const auto account, painter_.draw(*m.method, view, m.what->occluded));
    const double seconds = seconds_since(begin);
    m.ms.push_back(1000 * seconds);
    m.seconds += seconds;
    m.account = account;
    return {};
  }

  hal::Result<> dump(ui::BenchmarkView view, std::string_view method,
                     const pipeline::Image& image) const {
    if (!options_.dump)
      return {};
    return pipeline::write_png(*options_.dump / fmt::format("{}_{}.png", to_string(view), method),
                               image);
  }

  void report(ui::BenchmarkView view, const VesselsBenchCase& made) const {
    if (options_.progress)
      options_.progress(fmt::format("{:<6} {:<17} {:>9.1f} ms, {} frames, {}", to_string(view),
                                    made.method, made.ms_p50, made.frames, describe(made.account)));
  }

  const pipeline::VesselClusters& tree_;
  const VesselsBenchOptions& options_;
  VesselsBenchPainter painter_;
  std::shared_ptr<ui::NodeTexture> nodes_;
  std::vector<std::pair<const VesselBenchMethod*, std::unique_ptr<ui::VesselMethod>>> methods_;
  std::unique_ptr<ui::VesselMethod> quads_;
  std::unique_ptr<ui::VesselMethod> brute_force_;
};

hal::Result<> measure(const pipeline::VesselClusters& tree, const VesselsBenchOptions& options,
                      VesselsBenchReport& report) {
  HAL_TRY(auto picture, ui::VesselPicture::create());
  VesselsBench bench{tree, options, std::move(picture)};
  HAL_CHECK(bench.make_methods());
  HAL_TRY(const auto upload, bench.upload_ms());
  report.upload_ms = upload;
  for (const ui::BenchmarkView view : options.views) {
    HAL_TRY(auto measured, bench.measure(view));
    report.views.push_back(std::move(measured));
  }
  if (options.flight_places > 0) {
    HAL_TRY(const auto flown, bench.fly());
    report.flight = flown;
  }
  return {};
}

} // namespace

const std::vector<VesselBenchMethod>& vessel_bench_methods() {
  static const std::vector<VesselBenchMethod> all = [] {
    std::vector<VesselBenchMethod> made;
    for (const ui::VesselMethodKind kind : ui::all_vessel_methods)
      made.push_back({std::string{to_string(kind)}, kind, ui::ClusterChoice::visible, false});
    made.push_back(
        {"hybrid-occluded", ui::VesselMethodKind::hybrid, ui::ClusterChoice::visible, true});
    made.push_back({std::string{brute_force_name}, ui::VesselMethodKind::quads_gpu,
                    ui::ClusterChoice::all, false});
    return made;
  }();
  return all;
}

const VesselsBenchCase* VesselsBenchView::find(std::string_view method) const {
  const auto found = std::ranges::find(cases, method, &VesselsBenchCase::method);
  return found == cases.end() ? nullptr : &*found;
}

hal::Result<VesselsBenchReport> bench_vessels(const pipeline::VesselClusters& tree,
                                              const VesselsBenchOptions& options) {
  if (options.dump)
    HAL_CHECK(make_folder(*options.dump));
  VesselsBenchReport report;
  report.cpu = processor_name();
  report.width = options.width;
  report.height = options.height;
  HAL_TRY(const auto gl, OffscreenGl::open(options.width, options.height));
  report.gl_renderer = ui::gl::describe_context().renderer;
  HAL_CHECK(measure(tree, options, report));
  return report;
}

} // namespace octascope::firmware_host
