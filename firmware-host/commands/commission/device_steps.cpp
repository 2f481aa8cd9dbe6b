#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "firmware-host/commands/commission/live_look.h"
#include "firmware-host/commands/commission/spectrum_display.h"
#include "firmware-host/commands/commission/spectrum_text.h"
#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/devices/hardware_survey.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/number_text.h"
#include "sim/phantoms/phantom.h"

namespace octascope::firmware_host {

namespace {

hal::Result<LiveLook> look_now(Bench& bench, std::string_view phantom, int pulses) {
  HAL_TRY(const auto options, bench.session.run_options(phantom));
  HAL_TRY(const auto configuration, bench.session.configuration());
  return look(options, configuration, pulses, bench.clock);
}

void say_video_nodes(const std::vector<FoundDevice>& nodes) {
  for (const FoundDevice& device : nodes)
    say("  {}  {}{}\n", device.node, device.name,
        device.usable ? std::string{} : " (" + device.why_not + "; " + device.remedy + ")");
  if (nodes.empty())
    say("  No video node: is the camera on, and its cable and its driver there? `octascope doctor` "
        "says more.\n  Quit, and give the same command again when it is there; a GenICam camera "
        "needs no "
        "node.\n");
}

hal::Result<> ask_which_camera(Bench& bench) {
  if (bench.session.simulated()) {
    bench.session.set("line_camera", "sim");
    return {};
  }
  say_video_nodes(survey_hardware().video);
  HAL_TRY(
      auto camera,
      bench.dialogue.ask("Line camera: auto, a node as /dev/video0, or as gigevision:192.168.1.20?",
                         bench.session.text("line_camera", "auto")));
  bench.session.set("line_camera", camera);
  return {};
}

void say_gpio_lines(const std::vector<FoundDevice>& chips) {
  for (const FoundDevice& chip : chips) {
    const auto lines = std::ranges::find(chip.facts, "lines", &FoundDevice::Fact::first);
    say("  {}  {}: {}\n", chip.node, chip.name,
        lines != chip.facts.end() ? "lines " + lines->second : chip.why_not + "; " + chip.remedy);
  }
}

// In mm, as somebody would say it. Taken as it stands it changes nothing.
hal::Result<> ask_width(Bench& bench, const char* question, const char* key, double steps) {
  constexpr double usual_mm = 3;
  Session& session = bench.session;
  const double known_um = session.number(key, usual_mm * 1000 / steps);
  const double known_mm = known_um * steps / 1000;
  const double offered_mm =
      hal::number_of<double>(fmt::format("{:.4g}", known_mm)).value_or(known_mm);
  HAL_TRY(const double width_mm, bench.dialogue.ask_number(question, offered_mm, 0.01, 1000));
  session.set(key, width_mm == offered_mm ? known_um : width_mm * 1000 / steps);
  return {};
}

hal::Result<> ask_scan(Bench& bench) {
  Session& session = bench.session;
  const auto ask_count = [&](const char* key, const char* question, int fallback, int lowest,
                             int highest) -> hal::Result<> {
    HAL_TRY(const int count,
            bench.dialogue.ask_count(question, static_cast<int>(session.number(key, fallback)),
                                     lowest, highest));
    session.set(key, count);
    return {};
  };
  HAL_CHECK(ask_count("samples", "Samples of a line (pixels of the camera)?", 1024, 64, 65536));
  HAL_CHECK(ask_count("a_scans", "A-scans kept of each B-scan?", 300, 8, 65536));
  HAL_CHECK(ask_count("fly_back_lines", "Lines of the fly-back after them?", 79, 0, 65536));
  HAL_CHECK(ask_count("b_scans", "B-scans of a volume?", 80, 3, 65536));
  HAL_TRY(const double rate, bench.dialogue.ask_number(
                                 "Lines a second?", session.number("line_rate_hz", 215e3), 1, 1e9));
  session.set("line_rate_hz", rate);
  HAL_CHECK(ask_width(bench, "Width of the scan along a B-scan, in mm?", "a_spacing_um",
                      session.number("a_scans", 300)));
  HAL_CHECK(ask_width(bench, "Width from the first B-scan to the last, in mm?", "b_spacing_um",
                      session.number("b_scans", 80)));
  return {};
}

// What the driver says of a sample may be its room: 12 bits in 16. `before`: what was said then.
hal::Result<LiveLook> ask_bits(Bench& bench, LiveLook found, const Session& before) {
  const double offered = before.number("significant_bits", found.format.significant_bits);
  HAL_TRY(const int bits, bench.dialogue.ask_count("Significant bits of a sample?",
                                                   static_cast<int>(offered), 8, 16));
  bench.session.set("significant_bits", bits);
  if (bits != found.format.significant_bits) {
    HAL_TRY(found, look_now(bench, "dark", 0)); // does it offer them?
  }
  return found;
}

// A look with what was chosen for the camera before is refused by another one that came to have its
// name, and the step would never get to ask: it is looked at as it is. The same one has its light
// again.
hal::Result<LiveLook> look_at_camera(Bench& bench) {
  Session& session = bench.session;
  if (session.simulated())
    return look_now(bench, "dark", 0);
  const Session before = session;
  for (const char* const chosen : {"significant_bits", "exposure_us", "gain"})
    session.unset(chosen);
  HAL_TRY(auto found, look_now(bench, "dark", 0));
  HAL_TRY(found, ask_bits(bench, std::move(found), before));
  if (!found.camera.empty() && found.camera == before.text("camera"))
    for (const char* const chosen : {"exposure_us", "gain"})
      if (const double value = before.number(chosen, NAN); !std::isnan(value))
        session.set(chosen, value);
  return found;
}

// The configuration takes no others, and whole gains alone.
constexpr double least_exposure_us = 0.01;
constexpr double most_exposure_us = 1e6;
constexpr double most_gain = 1e6; // of either sign: a camera may give the bounds of its numbers

// Each returns whether the answer is another value than the camera has.
hal::Result<bool> ask_exposure(Bench& bench, const hal::CameraControl& exposure) {
  const double least = std::max(exposure.least, least_exposure_us);
  const double most = std::max(std::min(exposure.most, most_exposure_us), exposure.value);
  HAL_TRY(const double value,
          bench.dialogue.ask_number(fmt::format("Exposure in µs, {} to {}?", least, most),
                                    exposure.value, std::min(least, exposure.value), most));
  if (value == exposure.value)
    return false;
  bench.session.set("exposure_us", value);
  return true;
}

hal::Result<bool> ask_gain(Bench& bench, const hal::CameraControl& gain) {
  const auto whole = [](double value) {
    return static_cast<int>(std::clamp(value, -most_gain, most_gain));
  };
  const int least = whole(std::ceil(gain.least));
  const int most = std::max(least, whole(std::floor(gain.most)));
  const int present = std::clamp(whole(std::round(gain.value)), least, most);
  HAL_TRY(const int value, bench.dialogue.ask_count(fmt::format("Gain, {} to {}?", least, most),
                                                    present, least, most));
  if (value == present)
    return false;
  bench.session.set("gain", value);
  return true;
}

// Beside what they do to the light. True: one of them is another now.
hal::Result<bool> ask_controls(Bench& bench, const LiveLook& found) {
  const auto& [exposure, gain] = found.controls;
  if (exposure || gain)
    say("  brightest sample {}, {:.1f} % of the lines saturated, darkest pixels {:.0f} counts\n",
        brightness_text(found), found.quality.saturated_share * 100, found.quality.dark_counts);
  bool changed = false;
  if (exposure) {
    HAL_TRY(changed, ask_exposure(bench, *exposure));
  }
  if (gain) {
    HAL_TRY(const bool another, ask_gain(bench, *gain));
    changed = changed || another;
  }
  return changed;
}

// Shown over and over until Enter, where somebody sits at a terminal; else once.
hal::Result<LiveLook> watch_spectrum(Bench& bench, const std::string& phantom,
                                     SpectrumDisplay& display) {
  const bool live = ::isatty(STDIN_FILENO) != 0 && ::isatty(STDERR_FILENO) != 0;
  HAL_TRY(const auto options, bench.session.run_options(phantom));
  HAL_TRY(const auto configuration, bench.session.configuration());
  HAL_TRY(const auto watch, LineWatch::open(options, configuration, true, bench.clock));
  if (live) {
    display.open(options, configuration);
    say("Live: the spectrum's height is its brightness, full scale the highest. Enter goes on.\n");
  }
  std::fflush(stdout);
  for (;;) {
    auto looked = watch->look(1);
    if (live && (!looked || looked->mean_line.empty()))
      show_progress("");
    HAL_TRY(auto found, std::move(looked));
    if (found.mean_line.empty())
      return hal::fail(hal::ErrorCode::timed_out,
                       "no frame came: is the camera on, and does the trigger start the scanner?");
    if (!live)
      return found;
    show_progress(fmt::format("{} {:3.0f} % full, contrast {:4.1f} %, saturated {:.0f} %, lost {}",
                              spectrum_strip(found.mean_line, found.format.full_scale()),
                              found.quality.brightest * 100, found.quality.contrast * 100,
                              found.quality.saturated_share * 100, found.lost_frames));
    display.show(found);
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    const bool answered = ::poll(&input, 1, 100) > 0;
    if (!answered && !display.ended())
      continue;
    show_progress("");
    display.close();
    if (answered) {
      HAL_TRY(const std::string ended, bench.dialogue.ask("Taken:", "as it is now"));
    }
    return found;
  }
}

std::vector<std::string_view> all_phantoms() {
  std::vector<std::string_view> names{sim::phantom_names.begin(), sim::phantom_names.end()};
  names.insert(names.end(), sim::bench_phantom_names.begin(), sim::bench_phantom_names.end());
  return names;
}

} // namespace

hal::Result<std::string> ask_to_place(Bench& bench, const std::string& what,
                                      const std::string& phantom) {
  if (bench.session.simulated())
    return bench.dialogue.ask_name(what + " The twin looks at", phantom, all_phantoms());
  HAL_TRY(const std::string ready, bench.dialogue.ask(what + " Enter when it is so:", "ready"));
  return phantom;
}

// What was said of it.
std::string scan_text(const Session& session) {
  const double a_scans = session.number("a_scans", 0);
  const double b_scans = session.number("b_scans", 0);
  return fmt::format("{:.0f} A-scans and {:.0f} lines of fly-back a B-scan, {:.0f} B-scans, {:.0f} "
                     "lines a second, "
                     "{:.4g} x {:.4g} mm",
                     a_scans, session.number("fly_back_lines", 0), b_scans,
                     session.number("line_rate_hz", 0),
                     session.number("a_spacing_um", 0) * a_scans / 1000,
                     session.number("b_spacing_um", 0) * b_scans / 1000);
}

hal::Result<StepRecord> find_camera(Bench& bench) {
  HAL_CHECK(ask_which_camera(bench));
  const double samples = bench.session.number("samples", 0);
  HAL_CHECK(ask_scan(bench));
  if (bench.session.number("samples", 0) != samples)
    bench.session.set("calibration", ""); // it is of lines of another length
  HAL_TRY(const auto found, look_at_camera(bench));
  bench.session.set("camera", found.camera);
  StepRecord record;
  record.found = {{"camera", found.camera.empty() ? "does not identify itself" : found.camera},
                  {"found as", found.chosen},
                  {"samples", fmt::format("{} a line, of {} bits", found.format.samples,
                                          found.format.significant_bits)},
                  {"scan", scan_text(bench.session)}};
  if (found.camera.empty())
    record.warnings.emplace_back("the camera cannot be told from others of its kind: nobody will "
                                 "notice when another one takes its place");
  return record;
}

hal::Result<StepRecord> count_trigger(Bench& bench) {
  constexpr int pulses = 5;
  Session& session = bench.session;
  if (!session.simulated()) {
    say_gpio_lines(survey_hardware().gpio);
    HAL_TRY(const auto line,
            bench.dialogue.ask("GPIO line of the trigger: its name, or as gpiochip0:17?",
                               session.text("trigger_line", "octascope-trigger")));
    HAL_TRY(const auto sync, bench.dialogue.ask("GPIO line on which the scanner answers, or none?",
                                                session.text("sync_line", "none")));
    HAL_TRY(const double width,
            bench.dialogue.ask_number("Width of a pulse in µs?",
                                      session.number("pulse_width_us", 50), 1, 1e5));
    session.set("trigger_line", line);
    session.set("sync_line", sync == "none" ? "" : sync);
    session.set("pulse_width_us", width);
  }
  HAL_TRY(const auto found, look_now(bench, "dark", pulses));
  StepRecord record;
  record.found = {
      {"trigger", found.trigger},
      {"pulse", fmt::format("{:g} µs wide", session.number("pulse_width_us", 50))},
      {"pulses answered", fmt::format("{} of {}", found.answered, found.pulses)},
      {"frames", fmt::format("{} of {}, {} lost, {} broken", found.frames, found.expected_frames,
                             found.lost_frames, found.broken_frames)}};
  if (found.answered == 0)
    return hal::fail(hal::ErrorCode::timed_out,
                     "none of {} pulses was followed by a frame: is the trigger wired to the "
                     "scanner, and does the scanner start the camera's frames?",
                     found.pulses);
  if (!session.text("sync_line").empty())
    record.found.emplace_back("without an answer on the sync line",
                              fmt::format("{}", found.unanswered_on_sync));
  if (found.line_rate_hz > 0)
    record.found.emplace_back("lines a second", fmt::format("{:.0f}", found.line_rate_hz));
  const double wanted = session.number("line_rate_hz", 215e3);
  if (found.line_rate_hz > 0 && std::abs(found.line_rate_hz / wanted - 1) > 0.02)
    record.warnings.push_back(fmt::format("the frames' times say {:.0f} lines a second, expected "
                                          "{:.0f}: repeat the step \"camera\" with the right rate",
                                          found.line_rate_hz, wanted));
  if (found.lost_frames > 0)
    record.warnings.emplace_back("frames were lost between the camera and the program: has this "
                                 "machine other work, or is the cable at fault?");
  else if (found.frames != found.expected_frames || found.answered != found.pulses)
    record.warnings.emplace_back("not every pulse brought a whole volume: is the number of B-scans "
                                 "that of the scanner?");
  return record;
}

hal::Result<StepRecord> look_at_spectrum(Bench& bench) {
  HAL_TRY(const auto phantom,
          ask_to_place(bench, "Lay a mirror under the beam and block nothing.", "mirror_near"));
  LiveLook found;
  SpectrumDisplay display{bench.clock};
  for (bool changed = true; changed;) {
    HAL_TRY(found, watch_spectrum(bench, phantom, display));
    say("  {}\n", spectrum_strip(found.mean_line, found.format.full_scale()));
    HAL_TRY(changed, ask_controls(bench, found));
  }
  StepRecord record;
  if (const auto& exposure = found.controls.exposure_us)
    record.found.emplace_back("exposure", fmt::format("{:g} µs", exposure->value));
  if (const auto& gain = found.controls.gain)
    record.found.emplace_back("gain", fmt::format("{:g}", gain->value));
  add_quality(record, found);
  warn_of_contrast(record, found.quality);
  const auto picture = bench.session.free_file("spectrum", ".png");
  HAL_CHECK(pipeline::write_png(
      picture, draw_spectrum(found.mean_line, found.one_line, found.format.full_scale())));
  record.pictures.push_back(picture.filename().string());
  return record;
}

} // namespace octascope::firmware_host
