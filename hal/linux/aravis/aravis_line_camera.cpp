#include "hal/linux/aravis/aravis_line_camera.h"

#include <algorithm>
#include <utility>

#include "hal/linux/aravis/genicam_pixels.h"

namespace octascope::hal::linux_backend {

using namespace std::chrono_literals;

namespace {

// Shorter than the time within which a device's thread must make a step.
constexpr Duration most_closing = 4s;

// What the device's signal is given; both outlive the device.
struct Lost {
  std::atomic<bool>& lost;
  Semaphore& news;
};

void on_lost(ArvDevice* /*device*/, void* data) {
  const auto* told = static_cast<Lost*>(data);
  told->lost.store(true, std::memory_order_release);
  told->news.post();
}

void forget_lost(void* data, GClosure* /*closure*/) {
  delete static_cast<Lost*>(data);
}

} // namespace

AravisLineCamera::AravisLineCamera(GenicamCameraOptions options, Clock& clock)
    : options_{std::move(options)}, name_{to_text(options_.address)}, clock_{clock} {}

AravisLineCamera::~AravisLineCamera() {
  do_close();
  if (closing_.joinable())
    closing_.join();
}

std::string AravisLineCamera::do_identity() const {
  const std::lock_guard lock{identity_mutex_};
  return identity_;
}

Result<> AravisLineCamera::do_open(const LineCameraConfig& config) {
  HAL_CHECK(check_genicam_request(config));
  HAL_CHECK(wait_until_closed());
  if (auto opened = open_camera_of(config); !opened) {
    do_close();
    return opened;
  }
  set_state(DeviceState::ready);
  return {};
}

Result<> AravisLineCamera::open_camera_of(const LineCameraConfig& config) {
  if (!aravis_) {
    HAL_TRY(auto loaded, AravisLibrary::load());
    aravis_ = loaded;
  }
  HAL_TRY(auto camera, open_camera(*aravis_, options_.address));
  camera_ = std::move(camera);
  lost_.store(false, std::memory_order_release);
  watch();
  HAL_TRY(const auto stream, set_features(*aravis_, camera_.get(), options_, config));
  stream_ = stream;
  config_ = config;
  slots_ = std::make_unique<FrameSlots>(
      config.buffers, std::max(stream.payload_bytes, config.format.frame_bytes()));
  const std::string identity = identity_of(*aravis_, camera_.get());
  const std::lock_guard lock{identity_mutex_};
  identity_ = identity;
  return {};
}

void AravisLineCamera::watch() {
  watch_ = aravis_->signal_connect_data(aravis_->camera_get_device(camera_.get()), "control-lost",
                                        reinterpret_cast<GCallback>(&on_lost),
                                        new Lost{lost_, news_}, &forget_lost, GConnectFlags{});
}

Result<> AravisLineCamera::do_start() {
  auto started = lost_.load(std::memory_order_acquire) ? Result<>{gone()} : start_stream();
  if (!started) {
    server_.reset();
    if (started.error().code == ErrorCode::disconnected)
      set_state(DeviceState::failed);
    return started;
  }
  set_state(DeviceState::streaming);
  return {};
}

Result<> AravisLineCamera::start_stream() {
  news_.take_all();
  HAL_TRY(auto server, FrameServer::start(*aravis_,
                                          {.camera = camera_.get(),
                                           .name = name_,
                                           .stream = stream_,
                                           .format = config_.format,
                                           .packet_resend = options_.packet_resend},
                                          *slots_, clock_, news_, returns_));
  server_ = std::move(server);
  AravisAnswer answer{*aravis_};
  aravis_->camera_start_acquisition(camera_.get(), answer.out());
  if (answer.failed())
    return answer.error(name_, "starting", ErrorCode::disconnected);
  return {};
}

Result<std::optional<LineFrame>> AravisLineCamera::do_wait_frame(Duration timeout) {
  const TimePoint deadline = deadline_after(clock_.now(), timeout);
  while (true) {
    if (const auto slot = slots_->fetch())
      return handed_out(*slot);
    if (lost_.load(std::memory_order_acquire))
      return gone();
    if (clock_.now() >= deadline)
      return std::nullopt;
    clock_.wait_until(news_, deadline);
  }
}

LineFrame AravisLineCamera::handed_out(int slot) const {
  const ServedFrame& served = slots_->frame(slot);
  const Duration to_last =
      from_seconds((config_.format.lines_per_frame - 1) / config_.line_rate_hz);
  const Duration whole = from_seconds(config_.format.lines_per_frame / config_.line_rate_hz);
  return {.buffer = slot,
          .bytes = slots_->bytes(slot).first(served.bytes),
          .sequence = served.sequence,
          .first_line = served.end - whole,
          .last_line = served.end - whole + to_last,
          .integrity = served.integrity};
}

tl::unexpected<Error> AravisLineCamera::gone() {
  set_state(DeviceState::failed);
  return fail(ErrorCode::disconnected,
              "{}: the camera does not answer any more; check cable and power; it is opened again "
              "when it is back",
              name_);
}

void AravisLineCamera::do_release(int buffer) {
  if (slots_ && slots_->give_back(buffer))
    returns_.post();
}

// False if the camera does not answer.
bool AravisLineCamera::stop_acquisition() {
  if (lost_.load(std::memory_order_acquire) || state() == DeviceState::failed)
    return false;
  if (!server_)
    return true;
  AravisAnswer answer{*aravis_};
  aravis_->camera_stop_acquisition(camera_.get(), answer.out());
  return !answer.failed();
}

void AravisLineCamera::do_stop() {
  if (state() != DeviceState::streaming)
    return;
  stop_acquisition();
  server_.reset();
  set_state(DeviceState::ready);
}

void AravisLineCamera::do_close() {
  if (camera_) {
    const bool answers = stop_acquisition();
    aravis_->signal_handler_disconnect(aravis_->camera_get_device(camera_.get()), watch_);
    if (!answers)
      close_beside();
  }
  server_.reset();
  slots_.reset();
  camera_.reset();
  set_state(DeviceState::absent);
}

void AravisLineCamera::close_beside() {
  closing_ = std::thread{[this, camera = std::move(camera_), slots = std::move(slots_),
                          server = std::move(server_)]() mutable {
    server.reset();
    slots.reset();
    camera.reset();
    closed_.post();
  }};
}

Result<> AravisLineCamera::wait_until_closed() {
  if (!closing_.joinable())
    return {};
  const TimePoint began = clock_.now();
  const bool closed = clock_.wait_until(closed_, began + most_closing);
  if (closed)
    closing_.join();
  if (closed && clock_.now() - began < most_closing / 2) // opening may take as long
    return {};
  return fail(ErrorCode::absent,
              "{}: the camera that went is being closed; it is looked for at the next try", name_);
}

std::unique_ptr<LineCamera> make_genicam_camera(GenicamCameraOptions options, Clock& clock) {
  return std::make_unique<AravisLineCamera>(std::move(options), clock);
}

Result<GenicamFinding> find_genicam_camera(const GenicamAddress& address) {
  HAL_TRY(const auto aravis, AravisLibrary::load());
  HAL_TRY(const auto camera, open_camera(aravis, address));
  GenicamFinding finding;
  finding.camera = identity_of(aravis, camera.get());
  HAL_TRY(auto formats, offered_formats(aravis, camera.get(), to_text(address)));
  finding.pixel_formats = std::move(formats);
  return finding;
}

} // namespace octascope::hal::linux_backend
