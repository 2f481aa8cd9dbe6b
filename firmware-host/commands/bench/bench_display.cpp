#include "firmware-host/commands/bench/bench_display.h"

#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/bench/bench_timing.h"
#include "firmware-host/commands/offscreen_gl.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/report/report_parts.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/files/png_image.h"
#include "pipeline/volume/occupancy.h"
#include "ui/gl/context_info.h"
#include "ui/gl/framebuffer.h"
#include "ui/scene/volume_painter.h"
#include "ui/transfer/auto_window.h"
#include "ui/view/camera.h"

namespace octascope::firmware_host {

namespace {

constexpr int directions = 8;
constexpr int fewest_frames = 4;      // where a frame takes seconds
constexpr float opaque_tissue = 0.5F; // of a voxel at the top of the window, per reference step
constexpr float translucent_tissue = 0.03F;

std::string name_of(const DisplayBenchCase& what) {
  return fmt::format("{}{}_{}x{}_{}_{}{}", to_string(what.technique),
                     !casts_rays(what.technique)                 ? ""
                     : what.backend == ui::RayBackend::processor ? "_processor"
                                                                 : "_shader",
                     what.width, what.height, what.steps, what.opaque ? "opaque" : "translucent",
                     what.flow ? "_flow" : "");
}

std::vector<DisplayBenchCase> all_cases(const DisplayBenchOptions& options, bool with_flow) {
  std::vector<DisplayBenchCase> cases;
  for (const auto& [width, height] : options.sizes)
    for (const ui::Technique technique : ui::all_techniques)
      for (const auto backend : {ui::RayBackend::processor, ui::RayBackend::shader})
        for (const int steps : {512, 256})
          for (const bool opaque : {true, false}) {
            if (!casts_rays(technique) && backend == ui::RayBackend::processor)
              continue;
            const bool asked =
                options.technique.value_or(technique) == technique &&
                (!casts_rays(technique) || options.rays.value_or(backend) == backend);
            if (!asked)
              continue;
            const bool opacity_matters =
                technique != ui::Technique::maximum && technique != ui::Technique::surface;
            if (!opacity_matters && !opaque)
              continue;
            if (technique == ui::Technique::surface && steps != 512) // it takes no steps
              continue;
            cases.push_back({technique, backend, width, height, steps, opaque});
            if (with_flow) {
              cases.push_back(cases.back());
              cases.back().flow = true;
            }
          }
  return cases;
}

class DisplayBench {
public:
  DisplayBench(const pipeline::Volume& volume, ui::VolumePainter painter)
      : volume_(volume), painter_(std::move(painter)) {
    if (const auto window = ui::suggest_window(volume)) {
      view_.window_offset_db = window->offset_db;
      view_.window_size_db = window->size_db;
    }
    view_.tilt_deg = 35;
    view_.distance = 2.4F;
    view_.see_through_db = 0; // every sample as it was measured, as other programs draw it
  }

  const ui::ViewState& view() const { return view_; }

  // With what flows in it, or without.
  hal::Result<> show(bool flow) {
    view_.vessels = flow ? ui::VesselsShown::flow : ui::VesselsShown::off;
    painter_.expect(view_);
    return painter_.show(volume_);
  }

  hal::Result<DisplayBenchResult> measure(const DisplayBenchCase& what, double seconds) {
    DisplayBenchResult result;
    result.what = what;
    HAL_CHECK(draw(what, -1));
    std::vector<double> ms;
    const auto start = BenchClock::now();
    for (int frame = 0;
         frame < fewest_frames || (frame < directions && seconds_since(start) < 4 * seconds) ||
         seconds_since(start) < seconds;
         ++frame) {
      const auto begin = BenchClock::now();
      HAL_CHECK(draw(what, frame));
      ms.push_back(1000 * seconds_since(begin));
    }
    result.frames = static_cast<int>(ms.size());
    result.ms_p50 = quantile(ms, 0.5);
    result.ms_p95 = quantile(ms, 0.95);
    return result;
  }

  // What the case draws from the first direction, on black.
  hal::Result<pipeline::Image> picture(const DisplayBenchCase& what) {
    HAL_CHECK(draw(what, 0));
    return ui::gl::read_framebuffer(what.width, what.height);
  }

  // Volumes that differ from one to the next, as live ones do.
  hal::Result<double> upload_ms(bool flow) {
    HAL_CHECK(show(flow));
    pipeline::Volume changing = volume_;
    std::vector<double> ms;
    for (int repeat = 0; repeat < 15; ++repeat) {
      for (std::size_t i = 0; i < changing.levels.size(); i += 64)
        ++changing.levels[i];
      const auto begin = BenchClock::now();
      HAL_CHECK(painter_.show(changing));
      ui::gl::finish();
      ms.push_back(1000 * seconds_since(begin));
    }
    return show(flow).map([&] { return quantile(ms, 0.5); });
  }

private:
  hal::Result<> draw(const DisplayBenchCase& what, int frame) {
    const ui::Rect rect{0, 0, what.width, what.height};
    ui::ViewState view = view_;
    view.technique = what.technique;
    view.vessels = what.flow ? ui::VesselsShown::flow : ui::VesselsShown::off;
    view.opacity = what.opaque ? opaque_tissue : translucent_tissue;
    // A little farther each round, so that no picture was drawn before.
    view.yaw_deg =
        static_cast<float>(35 + 45 * frame) + 0.1F * static_cast<float>(frame / directions);
    const float aspect = static_cast<float>(what.width) / static_cast<float>(what.height);
    const ui::Camera camera = ui::make_camera(view, ui::box_extents_mm(volume_.geometry), aspect);
    ui::DrawQuality quality{1, what.steps};
    quality.rays = what.backend;
    HAL_CHECK(painter_.finish(volume_, view, quality));
    if (casts_rays(what.technique) && painter_.backend(quality) != what.backend)
      return hal::fail(
          hal::ErrorCode::unsupported,
          "bench display: the processor cannot cast the rays of this volume: it is too large, or "
          "there is no code for its instruction set; measure with --drawn-by gl");
    HAL_CHECK(painter_.update(ui::StereoEye::centre, view, camera, quality, rect));
    ui::gl::clear_to_black(what.width, what.height);
    painter_.composite(ui::StereoEye::centre, rect, what.height);
    ui::gl::finish();
    return {};
  }

  const pipeline::Volume& volume_;
  ui::VolumePainter painter_;
  ui::ViewState view_;
};

// What the same picture is if somebody else draws it; nothing where nobody does.
std::optional<DisplayBenchCase> other_way(const DisplayBenchCase& what) {
  DisplayBenchCase other = what;
  if (what.technique == ui::Technique::surface)
    return std::nullopt;
  if (casts_rays(what.technique))
    other.backend =
        what.backend == ui::RayBackend::shader ? ui::RayBackend::processor : ui::RayBackend::shader;
  else
    other.technique = ui::Technique::rays;
  return other;
}

hal::Result<> dump(const pipeline::Volume& volume, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return hal::fail(hal::ErrorCode::system,
                     "{}: cannot be made: {}; choose a folder that you may write to",
                     folder.string(), error.message());
  return pipeline::write_nrrd(folder / "volume.nrrd", {volume.geometry, volume.levels});
}

double occupancy_ms(const pipeline::Volume& volume) {
  pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
  std::vector<double> ms;
  for (int b = 0; b < volume.geometry.b_scans; ++b) {
    const auto begin = BenchClock::now();
    occupancy.update(b, volume.b_scan(b));
    ms.push_back(1000 * seconds_since(begin));
  }
  return quantile(ms, 0.5);
}

} // namespace

hal::Result<DisplayBenchReport> bench_display(const pipeline::Volume& volume,
                                              const DisplayBenchOptions& options) {
  DisplayBenchReport report;
  report.cpu = processor_name();
  report.geometry = volume.geometry;
  if (options.dump)
    HAL_CHECK(dump(volume, *options.dump));
  HAL_TRY(auto gl, OffscreenGl::open(options.sizes.back()[0], options.sizes.back()[1]));
  report.gl_renderer = ui::gl::describe_context().renderer;
  {
    HAL_TRY(auto painter, ui::VolumePainter::create());
    DisplayBench bench{volume, std::move(painter)};
    HAL_CHECK(bench.show(false));
    report.window_offset_db = static_cast<double>(bench.view().window_offset_db);
    report.window_size_db = static_cast<double>(bench.view().window_size_db);
    HAL_TRY(const auto upload, bench.upload_ms(false));
    report.upload_ms_p50 = upload;
    if (volume.has_flow()) {
      HAL_TRY(const auto with_flow, bench.upload_ms(true));
      report.upload_with_flow_ms_p50 = with_flow;
    }
    const auto cases = all_cases(options, volume.has_flow());
    for (const DisplayBenchCase& what : cases) {
      HAL_TRY(auto result,
              bench.measure(what, options.seconds / static_cast<double>(cases.size())));
      HAL_TRY(const auto picture, bench.picture(what));
      // Pictures differ alike at every size.
      const bool smallest = what.width == options.sizes.front()[0];
      if (const auto other = smallest ? other_way(what) : std::nullopt) {
        HAL_TRY(const auto compared, bench.picture(*other));
        result.difference = mean_difference(picture, compared);
      }
      if (options.dump)
        HAL_CHECK(pipeline::write_png(*options.dump / (name_of(what) + ".png"), picture));
      report.cases.push_back(result);
    }
  }
  gl.reset();
  report.occupancy_ms_per_b_scan = occupancy_ms(volume);
  if (options.live) {
    HAL_TRY(const auto live, probe_live(1280, 720, 6));
    report.live = live;
  }
  return report;
}

std::string to_json(const DisplayBenchReport& report) {
  const pipeline::VolumeGeometry& g = report.geometry;
  nlohmann::ordered_json json{
      {"cpu", report.cpu},
      {"gl_renderer", report.gl_renderer},
      {"volume", {g.depths, g.a_scans, g.b_scans}},
      {"window_db", {report.window_offset_db, report.window_size_db}},
      {"upload_ms_p50", report.upload_ms_p50},
      {"occupancy_ms_per_b_scan", report.occupancy_ms_per_b_scan},
  };
  if (report.upload_with_flow_ms_p50)
    json["upload_with_flow_ms_p50"] = *report.upload_with_flow_ms_p50;
  auto& list = json["cases"] = nlohmann::ordered_json::array();
  for (const DisplayBenchResult& result : report.cases)
    list.push_back(
        {{"technique", to_string(result.what.technique)},
         {"drawn_by",
          casts_rays(result.what.technique) && result.what.backend == ui::RayBackend::processor
              ? "processor"
              : "gl"},
         {"size", fmt::format("{}x{}", result.what.width, result.what.height)},
         {"planes_or_step", fmt::format("1/{}", result.what.steps)},
         {"opacity", result.what.opaque ? "opaque" : "translucent"},
         {"flow", result.what.flow},
         {"frames", result.frames},
         {"ms_p50", result.ms_p50},
         {"ms_p95", result.ms_p95},
         {"mean_difference", result.difference ? nlohmann::ordered_json(*result.difference)
                                               : nlohmann::ordered_json()}});
  if (const auto& live = report.live) {
    json["knob_to_frame_ms_p50"] = live->knob_to_frame_ms_p50;
    json["knob_to_frame_ms_p95"] = live->knob_to_frame_ms_p95;
    json["start_to_first_picture_ms"] = live->start_to_first_picture_ms;
    json["live"] = {{"size", "1280x720"},
                    {"frames_per_s_turning", live->frames_per_s},
                    {"latency_ms_p50_turning", live->latency_ms_p50},
                    {"latency_ms_p95_turning", live->latency_ms_p95},
                    {"quality_turning", to_json(live->turning_quality)},
                    {"latency_ms_p50", live->resting_latency_ms_p50},
                    {"latency_ms_p95", live->resting_latency_ms_p95},
                    {"quality", to_json(live->resting_quality)},
                    {"lost_volumes", live->lost_volumes}};
  }
  return json.dump(2);
}

} // namespace octascope::firmware_host
