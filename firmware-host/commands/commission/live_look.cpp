#include "firmware-host/commands/commission/live_look.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/commands/calibrate/calibrate_inputs.h"
#include "firmware-host/devices/devices.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;

constexpr hal::Duration longest_silence = 3s; // after a pulse, with a machine that stands still
constexpr hal::Duration at_once = 100ms;
constexpr int lines_of_a_frame = 4; // that are looked at
constexpr std::size_t most_lines = 128;

// A camera on the network may take longer than one call waits; the next goes on with it.
template <class Call> hal::Result<> patiently(Call call) {
  hal::Result<> done = call();
  for (int more = 0; more < 10 && !done && done.error().code == hal::ErrorCode::absent; ++more)
    done = call();
  return done;
}

} // namespace

class LineWatch::Look {
public:
  Look(Devices& devices, hal::Clock& clock) : devices_(devices), clock_(clock) {}

  hal::Result<LiveLook> run(int pulses);

private:
  hal::Result<> forget_frames();
  hal::Result<> pulse();
  void take(const hal::LineFrame& frame);
  void keep_lines(const hal::LineFrame& frame);
  void judge();

  Devices& devices_;
  hal::Clock& clock_;
  LiveLook found_;
  std::optional<std::uint64_t> last_sequence_;
  // From one frame's first line to the next one's, all together: a single stamp may be late.
  hal::Duration frames_took_{};
  std::uint64_t frames_timed_ = 0;
  std::optional<hal::TimePoint> last_begin_;
  std::vector<double> lines_;
};

hal::Result<LiveLook> LineWatch::Look::run(int pulses) {
  found_.camera = devices_.line_camera().identity();
  found_.controls = devices_.line_camera().controls();
  found_.format = pipeline::SpectrumFormat{devices_.format()};
  if (pulses == 0)
    return found_;
  HAL_CHECK(forget_frames());
  for (int i = 0; i < pulses; ++i)
    HAL_CHECK(pulse());
  found_.unanswered_on_sync = devices_.new_missed_answers();
  if (!lines_.empty())
    judge();
  return found_;
}

// Of a look before: what came too late for it.
hal::Result<> LineWatch::Look::forget_frames() {
  for (;;) {
    HAL_TRY(const auto frame, devices_.line_camera().wait_frame({}));
    if (!frame)
      return {};
    devices_.line_camera().release(frame->buffer);
  }
}

// All frames of one volume, or what comes of them.
hal::Result<> LineWatch::Look::pulse() {
  const auto expected = static_cast<std::uint64_t>(devices_.plan().sweeps());
  HAL_CHECK(devices_.galvo_trigger().pulse());
  ++found_.pulses;
  found_.expected_frames += expected;
  last_begin_.reset(); // the time between two volumes is no frame's
  const std::uint64_t before = found_.frames + found_.lost_frames;
  hal::TimePoint last_news = clock_.now();
  while (found_.frames + found_.lost_frames < before + expected &&
         clock_.now() - last_news < longest_silence) {
    HAL_TRY(const auto frame, devices_.line_camera().wait_frame(at_once));
    if (!frame)
      continue;
    last_news = clock_.now();
    take(*frame);
    devices_.line_camera().release(frame->buffer);
  }
  if (found_.frames + found_.lost_frames > before)
    ++found_.answered;
  return {};
}

void LineWatch::Look::take(const hal::LineFrame& frame) {
  ++found_.frames;
  if (last_sequence_ && frame.sequence > *last_sequence_)
    found_.lost_frames += frame.sequence - *last_sequence_ - 1;
  if (last_begin_ && last_sequence_ && frame.sequence > *last_sequence_) {
    frames_took_ += frame.first_line - *last_begin_;
    frames_timed_ += frame.sequence - *last_sequence_;
  }
  last_sequence_ = frame.sequence;
  last_begin_ = frame.first_line;
  if (frame.integrity == hal::FrameIntegrity::good)
    keep_lines(frame);
  else
    ++found_.broken_frames;
}

void LineWatch::Look::keep_lines(const hal::LineFrame& frame) {
  const std::size_t bytes = found_.format.line_bytes();
  const int kept = devices_.plan().converted_lines();
  const int step = std::max(1, kept / lines_of_a_frame);
  for (int line = 0;
       line < kept && lines_.size() < most_lines * static_cast<std::size_t>(found_.format.samples);
       line += step) {
    const auto counts = to_numbers(
        frame.bytes.subspan(bytes * static_cast<std::size_t>(line), bytes), found_.format.type);
    for (const double count : counts)
      lines_.push_back(static_cast<double>(static_cast<unsigned>(count) >>
                                           static_cast<unsigned>(found_.format.right_shift)));
  }
}

void LineWatch::Look::judge() {
  const auto samples = static_cast<std::size_t>(found_.format.samples);
  found_.quality = pipeline::judge_spectra(lines_, samples, found_.format.full_scale());
  found_.one_line.assign(lines_.end() - static_cast<std::ptrdiff_t>(samples), lines_.end());
  found_.mean_line.assign(samples, 0);
  found_.highest_line.assign(samples, 0);
  const double count = static_cast<double>(lines_.size() / samples);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    found_.mean_line[i % samples] += lines_[i] / count;
    double& highest = found_.highest_line[i % samples];
    highest = std::max(highest, lines_[i]);
  }
  if (frames_took_ > hal::Duration{})
    found_.line_rate_hz = static_cast<double>(frames_timed_) * devices_.plan().lines_per_frame() /
                          hal::to_seconds(frames_took_);
}

LineWatch::~LineWatch() {
  devices_->line_camera().close();
  devices_->galvo_trigger().close();
}

hal::Result<std::unique_ptr<LineWatch>> LineWatch::open(const RunOptions& options,
                                                        const Configuration& configuration,
                                                        bool starts, hal::Clock& clock) {
  auto real =
      std::make_unique<RealDevices>(configuration.devices, plan_of(options, configuration), clock);
  const DeviceChoices choices =
      choose_devices(real->find_for(options), options, configuration.devices);
  if (camera_may_come(choices, options, configuration.devices))
    return hal::fail(hal::ErrorCode::absent,
                     "no line camera: {}; octascope doctor says more, and --sim works with a "
                     "simulated one",
                     choices.line_camera.reason);
  auto devices = std::make_unique<Devices>(std::move(real), choices, clock);
  HAL_CHECK(devices->make_others(choices, options, configuration, clock));
  std::unique_ptr<LineWatch> watch{new LineWatch{std::move(devices), clock}};
  watch->chosen_ = fmt::format("{}: {}", choices.line_camera.backend, choices.line_camera.reason);
  watch->trigger_ =
      fmt::format("{}: {}", choices.galvo_trigger.backend, choices.galvo_trigger.reason);
  hal::LineCamera& camera = watch->devices_->line_camera();
  HAL_CHECK(patiently([&] { return camera.open(watch->devices_->camera_config()); }));
  if (starts) {
    HAL_CHECK(
        watch->devices_->galvo_trigger().open({.pulse_width = configuration.devices.pulse_width}));
    HAL_CHECK(patiently([&] { return camera.start(); }));
  }
  return watch;
}

hal::Result<LiveLook> LineWatch::look(int pulses) {
  HAL_TRY(auto found, Look(*devices_, clock_).run(pulses));
  found.chosen = chosen_;
  found.trigger = trigger_;
  return found;
}

hal::Result<LiveLook> look(const RunOptions& options, const Configuration& configuration,
                           int pulses, hal::Clock& clock) {
  HAL_TRY(const auto watch, LineWatch::open(options, configuration, pulses > 0, clock));
  return watch->look(pulses);
}

} // namespace octascope::firmware_host
