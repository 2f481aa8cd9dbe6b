#include "hal/linux/libcamera/libcamera_scope_camera.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "hal/linux/libcamera/camera_link.h"
#include "hal/linux/libcamera/motion_jpeg.h"

namespace octascope::hal::linux_backend {

namespace {

using namespace std::chrono_literals;

constexpr Duration longest_silence = 3s;
constexpr Duration suspicious_silence = 100ms; // then it is looked whether the camera is there
constexpr Duration longest_drain = 300ms;
constexpr Duration longest_farewell = 1s; // until libcamera notices that a camera is gone
constexpr double most_frames_per_s = 1000;
constexpr int largest_side = 1 << 14;

Result<> check(const ScopeCameraConfig& wanted) {
  const auto side = [](int pixels) { return pixels >= 1 && pixels <= largest_side; };
  if (!side(wanted.width) || !side(wanted.height))
    return fail(ErrorCode::invalid_argument,
                "scope camera: {}x{} is asked for, expected 1x1 to {}x{}", wanted.width,
                wanted.height, largest_side, largest_side);
  if (!(wanted.frames_per_s > 0 && wanted.frames_per_s <= most_frames_per_s))
    return fail(ErrorCode::invalid_argument,
                "scope camera: {} frames/s are asked for, expected more than 0 to {}",
                wanted.frames_per_s, most_frames_per_s);
  return {};
}

enum class Place : std::uint8_t { idle, in_camera, on_loan, returned };

} // namespace

struct LibcameraScopeCamera::Parts {
  Parts(LibcameraSession& its_session, LibcameraScopeOptions its_options, Clock& its_clock)
      : session{its_session}, options{std::move(its_options)}, clock{its_clock} {}

  Result<> queue(std::size_t buffer);
  Result<> queue_those_back();
  // The newest of those that are done; the older ones go back.
  Result<std::optional<ScopeFrame>> take_newest();
  std::optional<ScopeFrame> accept(std::size_t buffer, const CameraLink::Completed& done);
  Error lost() const;
  std::optional<Error> silence(TimePoint now);
  // Waits until the camera has filled what it has, as far as that can be waited for.
  void drain();
  bool gone_unnoticed();
  void restart_session();

  LibcameraSession& session;
  LibcameraScopeOptions options;
  Clock& clock;
  SignalListener listener;
  std::unique_ptr<CameraLink> link;
  std::optional<MotionJpegDecoder> decoder;
  std::vector<std::vector<std::byte>> decoded; // one a buffer, for motion JPEG
  Duration period{};
  FrameOrder order;
  std::array<std::atomic<Place>, most_buffers> places{};
  std::size_t in_camera = 0;
  TimePoint last_sign; // of life: a frame, or the first buffer after the camera had none
  std::atomic<std::uint64_t> broken{0};
  std::atomic<std::uint64_t> undecodable{0};
};

Error LibcameraScopeCamera::Parts::lost() const {
  return {ErrorCode::disconnected,
          fmt::format("scope camera \"{}\": found it gone, expected it to stream; check the plug "
                      "and the cable; it is tried again by itself",
                      link->model())};
}

Result<> LibcameraScopeCamera::Parts::queue(std::size_t buffer) {
  if (auto queued = link->queue(buffer); !queued) {
    places[buffer].store(Place::idle, std::memory_order_relaxed);
    return listener.queue().gone() ? tl::make_unexpected(lost()) : queued;
  }
  if (in_camera++ == 0)
    last_sign = clock.now();
  return {};
}

Result<> LibcameraScopeCamera::Parts::queue_those_back() {
  for (std::size_t i = 0; i < link->buffers(); ++i) {
    Place expected = Place::returned;
    // In the camera before it is told so: the request may be done at once.
    if (places[i].compare_exchange_strong(expected, Place::in_camera, std::memory_order_acquire))
      HAL_CHECK(queue(i));
  }
  return {};
}

std::optional<ScopeFrame> LibcameraScopeCamera::Parts::accept(std::size_t buffer,
                                                              const CameraLink::Completed& done) {
  const FrameOrder::Place place = order.place(done.stamp, clock.now());
  if (!done.good) {
    broken.fetch_add(1, std::memory_order_relaxed);
    return std::nullopt;
  }
  const PictureLayout& layout = link->layout();
  ScopeFrame frame;
  frame.buffer = static_cast<int>(buffer);
  frame.width = layout.size.width;
  frame.height = layout.size.height;
  frame.stride_bytes = static_cast<int>(layout.stride);
  frame.format = pixel_format(layout.encoding);
  frame.pixels = done.bytes;
  frame.sequence = place.sequence;
  frame.time = place.time;
  if (decoder) {
    if (!decoder->decode(done.bytes, layout.size, decoded[buffer])) {
      undecodable.fetch_add(1, std::memory_order_relaxed);
      return std::nullopt;
    }
    frame.stride_bytes = 3 * layout.size.width;
    frame.pixels = decoded[buffer];
  }
  last_sign = clock.now();
  return frame;
}

Result<std::optional<ScopeFrame>> LibcameraScopeCamera::Parts::take_newest() {
  std::optional<std::size_t> newest;
  bool broken_off = false;
  while (const auto done = listener.queue().next()) {
    --in_camera;
    broken_off = link->given_up(*done) || broken_off;
    if (newest)
      places[*newest].store(Place::returned, std::memory_order_relaxed);
    newest = done;
  }
  if (!newest)
    return std::nullopt;
  if (broken_off) {
    places[*newest].store(Place::idle, std::memory_order_relaxed);
    return tl::make_unexpected(lost());
  }
  const CameraLink::Completed done = link->completed(*newest);
  const auto frame = accept(*newest, done);
  places[*newest].store(frame ? Place::on_loan : Place::returned, std::memory_order_relaxed);
  HAL_CHECK(queue_those_back());
  return frame;
}

std::optional<Error> LibcameraScopeCamera::Parts::silence(TimePoint now) {
  if (in_camera == 0 || now - last_sign < suspicious_silence)
    return std::nullopt;
  if (!link->present())
    return lost();
  if (now - last_sign < longest_silence)
    return std::nullopt;
  return Error{ErrorCode::timed_out,
               fmt::format("scope camera \"{}\": no good picture for {:.1f} s, expected one every "
                           "{:.0f} ms; check the cable; it is opened again by itself",
                           link->model(), to_seconds(now - last_sign), to_ms(period))};
}

void LibcameraScopeCamera::Parts::drain() {
  const TimePoint limit = clock.now() + longest_drain;
  while (in_camera > 0 && clock.now() < limit && link->can_be_stopped() &&
         !listener.queue().gone()) {
    listener.queue().semaphore().take_all();
    while (const auto done = listener.queue().next()) {
      --in_camera;
      static_cast<void>(link->given_up(*done));
    }
    if (in_camera > 0)
      clock.wait_until(listener.queue().semaphore(), std::min(limit, clock.now() + 50ms));
  }
}

// True: it is gone, and libcamera does not know it; or it has broken off.
bool LibcameraScopeCamera::Parts::gone_unnoticed() {
  if (link->can_be_stopped())
    return false;
  const TimePoint limit = clock.now() + longest_farewell;
  while (!link->present() && link->watched() && !listener.queue().gone() && clock.now() < limit) {
    listener.queue().semaphore().take_all();
    if (!listener.queue().gone())
      clock.wait_until(listener.queue().semaphore(), limit);
  }
  if (listener.queue().gone())
    link->stopped_by_itself();
  return !listener.queue().gone();
}

void LibcameraScopeCamera::Parts::restart_session() {
  session.restart();
  if (link->will_be_abandoned())
    link->shut_nodes();
}

LibcameraScopeCamera::LibcameraScopeCamera(LibcameraSession& session, LibcameraScopeOptions options,
                                           Clock& clock)
    : parts_{std::make_unique<Parts>(session, std::move(options), clock)} {}

LibcameraScopeCamera::~LibcameraScopeCamera() {
  do_close();
}

LibcameraScopeCamera::Losses LibcameraScopeCamera::losses() const {
  return {parts_->broken.load(std::memory_order_relaxed),
          parts_->undecodable.load(std::memory_order_relaxed)};
}

Result<> LibcameraScopeCamera::do_open(const ScopeCameraConfig& config) {
  HAL_CHECK(check(config));
  HAL_TRY(auto chosen, parts_->session.choose(parts_->options.camera, parts_->options.taken_nodes));
  auto link = CameraLink::open(chosen, config);
  if (!link) {
    // Nobody has it, and its nodes are busy: where it could not be stopped in order, libcamera
    // 0.0.3 itself streams on, and gives them back only at its end.
    if (link.error().code == ErrorCode::busy && CameraLink::is_free(chosen)) {
      chosen.camera.reset();
      parts_->session.restart();
    }
    return tl::make_unexpected(link.error());
  }
  if ((*link)->layout().encoding == Encoding::motion_jpeg) {
    HAL_TRY(auto decoder, MotionJpegDecoder::make());
    parts_->decoder.emplace(std::move(decoder));
    const PictureSize size = (*link)->layout().size;
    parts_->decoded.assign((*link)->buffers(),
                           std::vector<std::byte>(row_bytes(Encoding::rgb8, size.width) *
                                                  static_cast<std::size_t>(size.height)));
  }
  parts_->link = std::move(*link);
  parts_->listener.listen_to(chosen.camera);
  parts_->period = from_seconds(1 / config.frames_per_s);
  parts_->broken = 0;
  parts_->undecodable = 0;
  set_state(DeviceState::ready);
  return {};
}

Result<> LibcameraScopeCamera::do_start() {
  Parts& parts = *parts_;
  if (auto started = parts.link->start(parts.period); !started) {
    set_state(DeviceState::failed);
    return started;
  }
  parts.order = {};
  for (std::size_t i = 0; i < parts.link->buffers(); ++i) {
    Place expected = Place::idle;
    parts.places[i].compare_exchange_strong(expected, Place::returned, std::memory_order_relaxed);
  }
  if (auto queued = parts.queue_those_back(); !queued) {
    set_state(DeviceState::failed);
    return queued;
  }
  set_state(DeviceState::streaming);
  return {};
}

Result<std::optional<ScopeFrame>> LibcameraScopeCamera::do_wait_frame(Duration timeout) {
  Parts& parts = *parts_;
  CompletionQueue& queue = parts.listener.queue();
  const auto failed = [this](Error error) {
    set_state(DeviceState::failed);
    // At once, before it can come back; loans stay readable all the same.
    if (parts_->gone_unnoticed())
      parts_->restart_session();
    return tl::make_unexpected(std::move(error));
  };
  const TimePoint deadline = parts.clock.now() + timeout;
  for (;;) {
    queue.semaphore().take_all();
    if (queue.gone())
      return failed(parts.lost());
    if (auto queued = parts.queue_those_back(); !queued)
      return failed(queued.error());
    auto frame = parts.take_newest();
    if (!frame)
      return failed(frame.error());
    if (*frame)
      return frame;
    const TimePoint now = parts.clock.now();
    if (auto silent = parts.silence(now))
      return failed(std::move(*silent));
    if (now >= deadline)
      return std::nullopt;
    parts.clock.wait_until(queue.semaphore(), parts.in_camera > 0
                                                  ? std::min(deadline, now + suspicious_silence)
                                                  : deadline);
  }
}

void LibcameraScopeCamera::do_release(int buffer) {
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= most_buffers)
    return;
  Place expected = Place::on_loan;
  if (parts_->places[static_cast<std::size_t>(buffer)].compare_exchange_strong(
          expected, Place::returned, std::memory_order_release))
    parts_->listener.queue().semaphore().post();
}

void LibcameraScopeCamera::do_stop() {
  if (state() != DeviceState::streaming)
    return;
  Parts& parts = *parts_;
  parts.drain();
  parts.link->stop();
  while (parts.listener.queue().next())
    ;
  for (std::atomic<Place>& place : parts.places) {
    Place expected = Place::in_camera;
    place.compare_exchange_strong(expected, Place::idle, std::memory_order_relaxed);
  }
  parts.in_camera = 0;
  set_state(DeviceState::ready);
}

void LibcameraScopeCamera::do_close() {
  do_stop();
  Parts& parts = *parts_;
  if (parts.link) {
    parts.drain();
    const bool restart = parts.gone_unnoticed();
    // An abandoned camera's requests end here: libcamera's thread must not know them any more. One
    // that can be given back needs that thread.
    const bool abandoned = parts.link->will_be_abandoned();
    if (restart && abandoned)
      parts.restart_session();
    parts.link.reset();
    if (restart && !abandoned)
      parts.session.restart();
  }
  parts.listener.listen_to_none();
  parts.decoder.reset();
  parts.decoded.clear();
  for (std::atomic<Place>& place : parts.places)
    place.store(Place::idle, std::memory_order_relaxed);
  parts.in_camera = 0;
  set_state(DeviceState::absent);
}

} // namespace octascope::hal::linux_backend
