#include "hal/linux/aravis/frame_server.h"

#include <pthread.h>

namespace octascope::hal::linux_backend {

namespace {

constexpr guint64 look_every_us = 50'000; // whether the service is over

// A slot's number, as the pointer that a buffer carries.
void* number_as_pointer(int slot) {
  return reinterpret_cast<void*>(
      static_cast<std::intptr_t>(slot)); // NOLINT(performance-no-int-to-ptr)
}

int slot_of(const void* pointer) {
  return static_cast<int>(reinterpret_cast<std::intptr_t>(pointer));
}

} // namespace

Result<std::unique_ptr<FrameServer>>
FrameServer::open_stream(const AravisLibrary& aravis, const Setup& setup, FrameSlots& slots) {
  AravisAnswer answer{aravis};
  auto stream =
      own(aravis, aravis.camera_create_stream(setup.camera, nullptr, nullptr, answer.out()));
  if (answer.failed() || !stream)
    return answer.error(setup.name, "opening the stream", ErrorCode::disconnected);
  if (!setup.packet_resend) // only GigE Vision's has it, and only there it can be switched off
    aravis.object_set(stream.get(), "packet-resend", ARV_GV_STREAM_PACKET_RESEND_NEVER, nullptr);
  return std::unique_ptr<FrameServer>{new FrameServer{aravis, setup, slots, std::move(stream)}};
}

FrameServer::FrameServer(const AravisLibrary& aravis, const Setup& setup, FrameSlots& slots,
                         Reference<ArvStream> stream)
    : aravis_{aravis}, expected_{setup.stream}, format_{setup.format}, slots_{slots},
      stream_{std::move(stream)} {
  for (int slot = 0; slot < slots_.count(); ++slot) {
    const std::span<std::byte> memory = slots_.bytes(slot);
    buffers_.push_back(own(aravis_, aravis_.buffer_new_full(memory.size(), memory.data(),
                                                            number_as_pointer(slot), nullptr)));
  }
  queue_idle();
}

void FrameServer::begin_service(Clock& clock, Semaphore& news, Semaphore& returns) {
  clock_ = &clock;
  news_ = &news;
  returns_ = &returns;
  forget_frames();
  returns_->post(); // for what was given back meanwhile
  fetching_ = std::thread{[this] { fetch_frames(); }};
  returning_ = std::thread{[this] { return_slots(); }};
  ::pthread_setname_np(fetching_.native_handle(), "octa-genicam");
  ::pthread_setname_np(returning_.native_handle(), "octa-genicam-in");
}

void FrameServer::end_service() {
  if (over_.exchange(true) || !fetching_.joinable())
    return;
  returns_->post();
  returning_.join();
  fetching_.join();
}

FrameServer::~FrameServer() {
  end_service();
  stream_.reset(); // nothing is written into the slots any more
  slots_.reset();
}

void FrameServer::queue_idle() {
  for (int slot = 0; slot < slots_.count(); ++slot)
    if (slots_.queue(slot)) // the stream takes a reference of its own over
      aravis_.stream_push_buffer(
          stream_.get(), static_cast<ArvBuffer*>(
                             aravis_.object_ref(buffers_[static_cast<std::size_t>(slot)].get())));
}

// A start that was long in coming has filled the slots with frames of long ago.
void FrameServer::forget_frames() {
  while (ArvBuffer* const buffer = aravis_.stream_try_pop_buffer(stream_.get()))
    aravis_.stream_push_buffer(stream_.get(), buffer); // with the reference that we got
}

void FrameServer::return_slots() {
  while (!over_) {
    returns_->wait();
    returns_->take_all();
    queue_idle();
  }
}

void FrameServer::fetch_frames() {
  while (!over_) {
    ArvBuffer* const buffer = aravis_.stream_timeout_pop_buffer(stream_.get(), look_every_us);
    if (buffer == nullptr)
      continue;
    const TimePoint now = clock_->now();
    serve(slot_of(aravis_.buffer_get_user_data(buffer)), buffer, now);
    aravis_.object_unref(buffer);
  }
}

void FrameServer::serve(int slot, ArvBuffer* buffer, TimePoint now) {
  const ArvBufferStatus status = aravis_.buffer_get_status(buffer);
  if (status == ARV_BUFFER_STATUS_ABORTED || status == ARV_BUFFER_STATUS_CLEARED) {
    slots_.drop(slot); // no frame
    returns_->post();
    return;
  }
  ServedFrame frame;
  const guint64 id = aravis_.buffer_get_frame_id(buffer);
  // With a frame's first packet its number and time are lost: Aravis leaves those of the frame that
  // was in the buffer before, maybe one that was forgotten.
  const bool leader_lost = status != ARV_BUFFER_STATUS_SUCCESS && !counter_.follows(id);
  frame.sequence = leader_lost ? counter_.guess() : counter_.extend(id);
  frame.end =
      leader_lost ? now : camera_clock_.end_of_frame(aravis_.buffer_get_timestamp(buffer), now);
  frame.timed_by_host = !camera_clock_.fits();
  frame.integrity = judge(buffer, frame.bytes);
  if (frame.integrity == FrameIntegrity::good) {
    const std::size_t samples = format_.frame_bytes() / sizeof(std::uint16_t);
    unpack(expected_.packing, slots_.bytes(slot), samples);
    rescale(slots_.bytes(slot), samples, expected_.bits, format_.significant_bits);
  }
  slots_.serve(slot, frame);
  news_->post();
}

FrameIntegrity FrameServer::judge(ArvBuffer* buffer, std::size_t& bytes) const {
  bytes = format_.frame_bytes();
  if (aravis_.buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS)
    return FrameIntegrity::corrupted;
  const ArvBufferPayloadType payload = aravis_.buffer_get_payload_type(buffer);
  if (payload != ARV_BUFFER_PAYLOAD_TYPE_IMAGE &&
      payload != ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA)
    return FrameIntegrity::corrupted;
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  aravis_.buffer_get_image_region(buffer, &x, &y, &width, &height);
  if (width == format_.samples_per_line && height == format_.lines_per_frame &&
      aravis_.buffer_get_image_pixel_format(buffer) == expected_.pixel_format)
    return FrameIntegrity::good;
  bytes = 0;
  return FrameIntegrity::wrong_size;
}

} // namespace octascope::hal::linux_backend
