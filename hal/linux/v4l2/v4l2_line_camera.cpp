#include "hal/linux/v4l2/v4l2_line_camera.h"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <utility>

#include <fmt/format.h>

#include "hal/linux/system/system_error.h"
#include "hal/linux/v4l2/capture_buffers.h"
#include "hal/linux/v4l2/capture_node.h"
#include "hal/linux/v4l2/pixel_formats.h"
#include "hal/linux/v4l2/video_nodes.h"

namespace octascope::hal::linux_backend {

using namespace std::chrono_literals;

namespace {

Result<> check(const LineCameraConfig& config, const V4l2CameraOptions& options) {
  const auto refuse = [](std::string why) {
    return fail(ErrorCode::invalid_argument, "line camera: " + std::move(why));
  };
  if (const auto checked = check_request(config.format); !checked)
    return refuse(checked.error().message);
  if (!(config.line_rate_hz >= 1 && config.line_rate_hz <= 1e9))
    return refuse(fmt::format("line_rate_hz is {}, expected 1 to 1e9", config.line_rate_hz));
  if (config.buffers < 1)
    return refuse(fmt::format("buffers is {}, expected 1 or more", config.buffers));
  if (const auto& window = options.window; window && (window->width < 1 || window->height < 1))
    return refuse(fmt::format("the sensor's window is {}×{} pixels, expected at least 1×1",
                              window->width, window->height));
  return {};
}

Duration wall_clock_since_1970() {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return std::chrono::seconds{t.tv_sec} + std::chrono::nanoseconds{t.tv_nsec};
}

// Gone in the middle of open(): to whoever opens, it is not there.
Error absent_if_gone(Error error) {
  if (error.code == ErrorCode::disconnected)
    error.code = ErrorCode::absent;
  return error;
}

} // namespace

V4l2LineCamera::V4l2LineCamera(V4l2CameraOptions options, Clock& clock)
    : options_{std::move(options)}, clock_{clock} {}

V4l2LineCamera::~V4l2LineCamera() {
  do_close();
}

std::vector<std::string> V4l2LineCamera::notes() const {
  const std::lock_guard lock{notes_mutex_};
  return notes_;
}

std::string V4l2LineCamera::do_identity() const {
  const std::lock_guard lock{notes_mutex_};
  return camera_;
}

CameraControls V4l2LineCamera::do_controls() const {
  return node_ ? read_controls(node_->file()) : CameraControls{};
}

void V4l2LineCamera::note(std::vector<std::string> words) {
  const std::lock_guard lock{notes_mutex_};
  notes_ = std::move(words);
}

V4l2CameraTally V4l2LineCamera::tally() const {
  return {.own_stamps = own_stamps_.load(std::memory_order_relaxed),
          .failed_returns = failed_returns_.load(std::memory_order_relaxed)};
}

Result<> V4l2LineCamera::do_open(const LineCameraConfig& config) {
  HAL_CHECK(check(config, options_));
  const auto opened = find_node(config.format).and_then([&](const std::string& node) {
    return open_node(node, config);
  });
  if (!opened) {
    do_close();
    return tl::make_unexpected(absent_if_gone(opened.error()));
  }
  set_state(DeviceState::ready);
  return {};
}

Result<std::string> V4l2LineCamera::find_node(const LineFormat& wanted) const {
  if (!options_.node.empty())
    return options_.node;
  return pick_line_camera(line_camera_candidates(wanted), bus_, wanted);
}

Result<> V4l2LineCamera::open_node(const std::string& node, const LineCameraConfig& config) {
  HAL_TRY(auto opened, CaptureNode::open(node));
  node_ = std::make_unique<CaptureNode>(std::move(opened));
  const NodeIdentity& identity = node_->identity();
  std::vector<std::string> words{
      fmt::format("{} is \"{}\" ({}) at {}", node, identity.camera, identity.driver, identity.bus)};
  if (options_.input) {
    HAL_CHECK(node_->select_input(*options_.input));
    words.push_back(fmt::format("input {} selected", *options_.input));
  }
  if (options_.window) {
    HAL_CHECK(node_->set_window(*options_.window));
  }
  HAL_TRY(const auto request, node_->choose_format(config.format));
  HAL_TRY(const auto given, node_->set_format(request));
  words.push_back(fmt::format("{} at {}×{}", fourcc_text(given.code), given.width, given.height));
  const int width = options_.window ? options_.window->width : config.format.samples_per_line;
  HAL_TRY(auto settings,
          apply_settings(node_->file(), node, options_.settings, config.line_rate_hz, width));
  std::ranges::move(settings, std::back_inserter(words));

  HAL_TRY(auto buffers, CaptureBuffers::map(node_->file(), node, config.buffers,
                                            std::min(config.buffers, least_buffers),
                                            config.format.frame_bytes()));
  buffers_ = std::move(buffers);
  words.push_back(fmt::format("{} buffers, {} asked for", buffers_->count(), config.buffers));

  config_ = config;
  image_bytes_ = given.image_bytes;
  bus_ = identity.bus;
  clocks_differ_ = tells_clocks_apart(clock_.now(), wall_clock_since_1970());
  note(std::move(words));
  const std::lock_guard lock{notes_mutex_};
  camera_ = identity.camera;
  return {};
}

std::optional<int> V4l2LineCamera::do_fewer_buffers() const {
  return buffers_ && buffers_->count() < config_.buffers ? std::optional{buffers_->count()}
                                                         : std::nullopt;
}

Result<> V4l2LineCamera::do_start() {
  sequence_ = {};
  if (auto started = buffers_->start(); !started) {
    if (started.error().code == ErrorCode::disconnected)
      set_state(DeviceState::failed);
    return started;
  }
  set_state(DeviceState::streaming);
  return {};
}

Result<std::optional<LineFrame>> V4l2LineCamera::do_wait_frame(Duration timeout) {
  const TimePoint deadline = deadline_after(clock_.now(), timeout);
  while (true) {
    buffers_->retry_strays();
    FetchedFrame fetched;
    const int why = buffers_->fetch(fetched);
    const TimePoint now = clock_.now();
    if (why == 0)
      return handed_out(fetched, now);
    if (why != EAGAIN)
      return broken("fetching a frame", why);
    if (now >= deadline)
      return std::nullopt;
    const int waited = buffers_->wait(deadline - now);
    if (waited == EAGAIN)
      clock_.sleep_for(std::min<Duration>(deadline - now, 1ms)); // until a loan comes back
    else if (waited != 0)
      return broken("waiting for a frame", waited);
  }
}

LineFrame V4l2LineCamera::handed_out(const FetchedFrame& fetched, TimePoint now) {
  const ExposureTimes times = exposure_times(fetched.stamp, now, clocks_differ_,
                                             config_.format.lines_per_frame, config_.line_rate_hz);
  if (times.own_clock)
    own_stamps_.fetch_add(1, std::memory_order_relaxed);
  const std::size_t expected = config_.format.frame_bytes();
  const std::span<const std::byte> all = buffers_->bytes(fetched.buffer);
  // Drivers count what they put behind the picture, or do not.
  const bool whole = fetched.bytes_used == expected || fetched.bytes_used == image_bytes_;
  LineFrame frame{
      .buffer = fetched.buffer,
      .bytes = all.first(whole ? expected : std::min<std::size_t>(fetched.bytes_used, all.size())),
      .sequence = sequence_.extend(fetched.sequence),
      .first_line = times.first_line,
      .last_line = times.last_line,
      .integrity = FrameIntegrity::good,
      .timed_by_host = times.own_clock};
  if (!whole)
    frame.integrity = FrameIntegrity::wrong_size;
  if (fetched.flagged)
    frame.integrity = FrameIntegrity::corrupted;
  return frame;
}

tl::unexpected<Error> V4l2LineCamera::broken(std::string_view action, int error_number) {
  set_state(DeviceState::failed);
  return system_failure(node_->identity().node, action, error_number);
}

void V4l2LineCamera::do_release(int buffer) {
  if (buffers_ && !buffers_->give_back(buffer) && state() != DeviceState::failed)
    failed_returns_.fetch_add(1, std::memory_order_relaxed);
}

void V4l2LineCamera::do_stop() {
  if (state() != DeviceState::streaming)
    return;
  buffers_->stop();
  set_state(DeviceState::ready);
}

void V4l2LineCamera::do_close() {
  if (state() == DeviceState::streaming)
    buffers_->stop();
  buffers_.reset();
  node_.reset();
  note({});
  set_state(DeviceState::absent);
}

} // namespace octascope::hal::linux_backend
