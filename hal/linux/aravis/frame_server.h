// Serves a camera's stream on threads of its own, so that nobody else meets Aravis's locks and
// allocations: one waits for frames, unpacks them and hands them to the slots, one gives idle slots
// back to the stream. They and Aravis's own inherit the priority of the threads that call this.
#pragma once

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "hal/clock.h"
#include "hal/linux/aravis/aravis_library.h"
#include "hal/linux/aravis/camera_clock.h"
#include "hal/linux/aravis/camera_features.h"
#include "hal/linux/aravis/frame_slots.h"
#include "hal/result.h"
#include "hal/semaphore.h"

namespace octascope::hal::linux_backend {

class FrameServer {
public:
  struct Setup {
    ArvCamera* camera = nullptr;
    std::string name; // for messages
    CameraStream stream;
    LineFormat format;
    bool packet_resend = true;
  };

  // Opens the camera's stream and gives it all idle slots; waits for the camera's answers. Nothing is
  // served yet. All references outlive this.
  static Result<std::unique_ptr<FrameServer>> open_stream(const AravisLibrary& aravis,
                                                          const Setup& setup, FrameSlots& slots);

  // Begins to hand frames on, of those that came before none. Posts `news` for each frame; whoever
  // makes a slot idle posts `returns`. `clock` and the semaphores are used until end_service().
  // Once; as quick as that, whatever the camera does.
  void begin_service(Clock& clock, Semaphore& news, Semaphore& returns);
  void end_service();

  // Ends all and the stream, too; all slots that are not lent are idle then.
  ~FrameServer();

private:
  FrameServer(const AravisLibrary& aravis, const Setup& setup, FrameSlots& slots,
              Reference<ArvStream> stream);
  void queue_idle();
  void forget_frames();
  void fetch_frames();
  void return_slots();
  void serve(int slot, ArvBuffer* buffer, TimePoint now);
  FrameIntegrity judge(ArvBuffer* buffer, std::size_t& bytes) const;

  const AravisLibrary& aravis_;
  const CameraStream expected_;
  const LineFormat format_;
  FrameSlots& slots_;
  Clock* clock_ = nullptr; // while serving, as the next two
  Semaphore* news_ = nullptr;
  Semaphore* returns_ = nullptr;
  Reference<ArvStream> stream_;
  std::vector<Reference<ArvBuffer>> buffers_; // one a slot, over its memory
  CameraClock camera_clock_;
  FrameCounter counter_;
  std::atomic<bool> over_{false};
  std::thread fetching_;
  std::thread returning_;
};

} // namespace octascope::hal::linux_backend
