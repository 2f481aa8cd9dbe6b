#include "hal/linux/aravis/aravis_line_camera.h"

#include <algorithm>
#include <utility>

#include "hal/linux/aravis/genicam_pixels.h"

namespace octascope::hal::linux_backend {

namespace {

void on_lost(ArvDevice* /*device*/, void* data) {
  auto* camera = static_cast<OpenCamera*>(data);
  camera->lost.store(true, std::memory_order_release);
  camera->news.post();
}

bool same(const LineCameraConfig& a, const LineCameraConfig& b) {
  return a.format == b.format && a.line_rate_hz == b.line_rate_hz && a.buffers == b.buffers;
}

// This and the next two wait for the camera's answers.
Result<std::unique_ptr<OpenCamera>> open_genicam(const AravisLibrary& aravis,
                                                 const GenicamCameraOptions& options,
                                                 const LineCameraConfig& config) {
  auto open = std::make_unique<OpenCamera>(aravis);
  HAL_TRY(open->camera, open_camera(open->aravis, options.address));
  ArvCamera* const camera = open->camera.get();
  aravis.signal_connect_data(aravis.camera_get_device(camera), "control-lost",
                             reinterpret_cast<GCallback>(&on_lost), open.get(), nullptr,
                             GConnectFlags{}); // the device ends before what it is given
  HAL_TRY(open->stream, set_features(open->aravis, camera, options, config));
  open->controls = controls_of(open->aravis, camera);
  open->slots = std::make_unique<FrameSlots>(
      config.buffers, std::max(open->stream.payload_bytes, config.format.frame_bytes()));
  return open;
}

Result<std::unique_ptr<FrameServer>> start_stream(OpenCamera& open,
                                                  const FrameServer::Setup& setup) {
  HAL_TRY(auto server, FrameServer::open_stream(open.aravis, setup, *open.slots));
  AravisAnswer answer{open.aravis};
  open.aravis.camera_start_acquisition(open.camera.get(), answer.out());
  if (answer.failed())
    return answer.error(setup.name, "starting", ErrorCode::disconnected);
  return server;
}

void end_stream(OpenCamera& open, std::unique_ptr<FrameServer> server) {
  if (!server)
    return;
  if (!open.lost.load(std::memory_order_acquire)) {
    AravisAnswer answer{open.aravis};
    open.aravis.camera_stop_acquisition(open.camera.get(), answer.out());
  }
  server.reset();
}

} // namespace

AravisLineCamera::AravisLineCamera(GenicamCameraOptions options, Clock& clock,
                                   std::optional<AravisLibrary> aravis)
    : options_{std::move(options)}, name_{to_text(options_.address)}, clock_{clock},
      aravis_{aravis}, errands_{clock} {}

AravisLineCamera::~AravisLineCamera() {
  do_close();
  if (opening_)
    errands_.start([opening = std::move(opening_)]() mutable { opening.reset(); });
}

std::string AravisLineCamera::do_identity() const {
  const std::lock_guard lock{identity_mutex_};
  return identity_;
}

Result<> AravisLineCamera::do_open(const LineCameraConfig& config) {
  HAL_CHECK(check_genicam_request(config));
  if (!aravis_) {
    HAL_TRY(auto loaded, AravisLibrary::load());
    aravis_ = loaded;
  }
  const bool asked_before = opening_ && same(opening_->config, config);
  if (!asked_before)
    begin_opening(config);
  auto opened = finish_opening();
  if (asked_before && !opened &&
      !opening_) { // what it answered may be old; else it is what is known
    begin_opening(config);
    if (const auto now = finish_opening(); now || !opening_)
      opened = now;
  }
  if (opened)
    set_state(DeviceState::ready);
  return opened;
}

void AravisLineCamera::begin_opening(const LineCameraConfig& config) {
  opening_ = std::make_shared<Opening>();
  opening_->config = config;
  errands_.start([opening = opening_, aravis = *aravis_, options = options_] {
    opening->camera = open_genicam(aravis, options, opening->config);
    if (opening->camera)
      opening->identity = identity_of(aravis, (*opening->camera)->camera.get());
  });
}

Result<> AravisLineCamera::finish_opening() {
  if (!errands_.wait())
    return fail(ErrorCode::absent,
                "{}: the camera has not answered for a second; check cable, power, the camera's "
                "address and the service's drop-in (docs/DEVICES.md); it is asked further",
                name_);
  const auto opening = std::move(opening_);
  HAL_TRY(open_, std::move(opening->camera));
  config_ = opening->config;
  const std::lock_guard lock{identity_mutex_};
  identity_ = opening->identity;
  return {};
}

Result<> AravisLineCamera::do_start() {
  if (!starting_) {
    if (lost())
      return gone();
    begin_starting();
  }
  auto started = finish_starting();
  if (started)
    set_state(DeviceState::streaming);
  else if (started.error().code == ErrorCode::disconnected)
    set_state(DeviceState::failed);
  return started;
}

void AravisLineCamera::begin_starting() {
  starting_ = std::make_shared<Starting>();
  errands_.start([starting = starting_, open = open_.get(),
                  setup = FrameServer::Setup{.camera = open_->camera.get(),
                                             .name = name_,
                                             .stream = open_->stream,
                                             .format = config_.format,
                                             .packet_resend = options_.packet_resend}] {
    starting->server = start_stream(*open, setup);
  });
}

Result<> AravisLineCamera::finish_starting() {
  if (!errands_.wait())
    return fail(
        ErrorCode::absent,
        "{}: the camera has not answered for a second while it was started; check cable and "
        "power; it is waited for further",
        name_);
  const auto starting = std::move(starting_);
  HAL_TRY(open_->server, std::move(starting->server));
  open_->news.take_all();
  open_->server->begin_service(clock_, open_->news, open_->returns);
  return {};
}

Result<std::optional<LineFrame>> AravisLineCamera::do_wait_frame(Duration timeout) {
  const TimePoint deadline = deadline_after(clock_.now(), timeout);
  while (true) {
    if (const auto slot = open_->slots->fetch())
      return handed_out(*slot);
    if (lost())
      return gone();
    if (clock_.now() >= deadline)
      return std::nullopt;
    clock_.wait_until(open_->news, deadline);
  }
}

LineFrame AravisLineCamera::handed_out(int slot) const {
  const ServedFrame& served = open_->slots->frame(slot);
  const Duration to_last =
      from_seconds((config_.format.lines_per_frame - 1) / config_.line_rate_hz);
  const Duration whole = from_seconds(config_.format.lines_per_frame / config_.line_rate_hz);
  return {.buffer = slot,
          .bytes = open_->slots->bytes(slot).first(served.bytes),
          .sequence = served.sequence,
          .first_line = served.end - whole,
          .last_line = served.end - whole + to_last,
          .integrity = served.integrity,
          .timed_by_host = served.timed_by_host};
}

tl::unexpected<Error> AravisLineCamera::gone() {
  set_state(DeviceState::failed);
  return fail(ErrorCode::disconnected,
              "{}: the camera does not answer any more; check cable and power; it is opened again "
              "when it is back",
              name_);
}

void AravisLineCamera::do_release(int buffer) {
  if (open_ && open_->slots && open_->slots->give_back(buffer))
    open_->returns.post();
}

void AravisLineCamera::do_stop() {
  if (state() != DeviceState::streaming && !starting_)
    return;
  end_streaming();
  set_state(errands_.wait() ? DeviceState::ready : DeviceState::failed);
}

// An errand has the stream from now on: close() may come while it is at work. A start under way is
// ended when it is done.
void AravisLineCamera::end_streaming() {
  if (open_->server)
    open_->server->end_service();
  errands_.start([open = open_.get(), starting = std::move(starting_),
                  server = std::move(open_->server)]() mutable {
    if (starting && starting->server)
      server = std::move(*starting->server);
    end_stream(*open, std::move(server));
  });
}

void AravisLineCamera::do_close() {
  if (open_) {
    const bool answers = state() != DeviceState::failed && !starting_ && !lost();
    end_streaming();
    errands_.start([open = std::move(open_)]() mutable { open.reset(); });
    if (answers)
      errands_.wait();
  }
  set_state(DeviceState::absent);
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
