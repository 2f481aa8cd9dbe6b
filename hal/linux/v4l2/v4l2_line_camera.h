// The line camera behind a V4L2 node: a sensor, or a frame grabber with such a driver.
//
// B-scans are read where the driver puts them: nothing is copied up to the reconstruction. The
// format is negotiated at each open(): samples of 8 bits as GREY; of 10, 12 or 14 bits by that name
// (Y10, Y12, Y14) or in a Y16; lines without padding, not interlaced.
//
// Faults, beyond those of hal::LineCamera:
// - The driver flags a frame as wrong: FrameIntegrity::corrupted, and the frame is handed out.
// - The driver stamps frames with a clock that is not ours: they are stamped when they are fetched,
//   which is less exact, and counted (tally()).
// - A buffer cannot be queued again: it is tried at every wait_frame(), and counted.
// - An error of the stream that does not pass: the state is `failed`; close() and open() again.
// - No frames although the camera is triggered: wait_frame() cannot know. The fixed-rate thread
//   tells ("missed_pulse"), and the picture is marked as stale.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "hal/linux/v4l2/camera_settings.h"
#include "hal/linux/v4l2/frame_times.h"
#include "hal/linux/v4l2/sensor_window.h"
#include "hal/linux/v4l2/sequence_counter.h"

namespace octascope::hal::linux_backend {

class CaptureBuffers;
class CaptureNode;
struct FetchedFrame;

struct V4l2CameraOptions {
  // "/dev/video2". Empty: the first node that suits, looked for at every open, so that a camera
  // that comes back under another number is found; where several suit, the one on the bus of the
  // last time.
  std::string node = {};
  std::optional<int> input = {};           // of a frame grabber with several; none: leave it
  std::optional<SensorWindow> window = {}; // none: leave it
  CameraSettings settings = {};
};

struct V4l2CameraTally {            // since the camera was made
  std::uint64_t own_stamps = 0;     // frames with the time of their fetching
  std::uint64_t failed_returns = 0; // buffers that were not queued again at once
};

class V4l2LineCamera final : public LineCamera {
public:
  // Fewer buffers than this, or than were configured, do not do: one is written to, one waits, and
  // two are with the pipeline. Kernels give up to 32, whatever is asked for.
  static constexpr int least_buffers = 4;

  // `clock` outlives the camera and is the monotonic one.
  V4l2LineCamera(V4l2CameraOptions options, Clock& clock);
  ~V4l2LineCamera() override;

  // What open() found and set, in words, one fact a line; empty while absent. Any thread.
  std::vector<std::string> notes() const;

  // Any thread.
  V4l2CameraTally tally() const;

private:
  std::string_view do_backend() const override { return "v4l2"; }
  bool do_simulated() const override { return false; }
  Result<> do_open(const LineCameraConfig& config) override;
  Result<> do_start() override;
  Result<std::optional<LineFrame>> do_wait_frame(Duration timeout) override;
  void do_release(int buffer) override;
  void do_stop() override;
  void do_close() override;
  std::string do_identity() const override;

  Result<std::string> find_node(const LineFormat& wanted) const;
  Result<> open_node(const std::string& node, const LineCameraConfig& config);
  Result<> wrong_state(std::string_view call, std::string_view expected) const;
  tl::unexpected<Error> broken(std::string_view action, int error_number);
  LineFrame handed_out(const FetchedFrame& fetched, TimePoint now);
  void note(std::vector<std::string> words);

  const V4l2CameraOptions options_;
  Clock& clock_;

  LineCameraConfig config_;
  std::unique_ptr<CaptureNode> node_;
  std::unique_ptr<CaptureBuffers> buffers_; // unmapped before the node is closed
  std::string bus_;                         // of the last open
  std::size_t image_bytes_ = 0;             // of a frame, with what the driver puts behind it
  bool clocks_differ_ = false;
  SequenceCounter sequence_;
  Error failure_; // in the state `failed`

  std::atomic<std::uint64_t> own_stamps_{0};
  std::atomic<std::uint64_t> failed_returns_{0};
  mutable std::mutex notes_mutex_; // never taken by the camera thread while streaming
  std::vector<std::string> notes_;
  std::string camera_; // of the last open
};

} // namespace octascope::hal::linux_backend
