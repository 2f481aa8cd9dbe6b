// The line camera on a V4L2 node: a sensor, or a frame grabber with a V4L2 driver.
//
// B-scans are read in the driver's buffers; nothing is copied before the reconstruction. The format
// is negotiated at each open(): 8-bit samples as GREY; 10, 12 or 14 bits as Y10, Y12, Y14 or in
// Y16; lines without padding, not interlaced.
//
// Faults, in addition to those of hal::LineCamera:
// - The driver flags a frame as wrong: it is delivered as FrameIntegrity::corrupted.
// - The driver's time stamps are of another clock: frames get the time when they were fetched,
//   which is less exact, and are counted (tally()).
// - A buffer cannot be queued again: it is retried at every wait_frame(), and counted.
// - A persistent stream error: the state is `failed`; close() and open() again.
// - No frames although the camera is triggered: wait_frame() cannot know. The fixed-rate thread
//   reports it ("missed_pulse"), and the image is marked as stale.
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
  // "/dev/video2". Empty: the first suitable node, searched at every open, so that a camera that
  // returns under another number is found; if several are suitable, the one on the bus used before.
  std::string node = {};
  std::optional<int> input = {};           // of a frame grabber; empty: unchanged
  std::optional<SensorWindow> window = {}; // empty: unchanged
  CameraSettings settings = {};
};

struct V4l2CameraTally {            // since construction
  std::uint64_t own_stamps = 0;     // frames stamped when fetched
  std::uint64_t failed_returns = 0; // buffers that could not be queued again immediately
};

class V4l2LineCamera final : public LineCamera {
public:
  // The driver must give at least this many buffers (or the configured number, if smaller): one
  // being written, one waiting and two in the pipeline. Most kernels give at most 32.
  static constexpr int least_buffers = 4;

  // `clock` is borrowed, must outlive the camera and must run on CLOCK_MONOTONIC.
  V4l2LineCamera(V4l2CameraOptions options, Clock& clock);
  ~V4l2LineCamera() override;

  // What open() found and set, as text, one fact per line; empty while absent. Any thread.
  std::vector<std::string> notes() const;

  // Any thread.
  V4l2CameraTally tally() const;

private:
  std::string_view do_backend() const override { return "v4l2"; }
  bool do_simulated() const override { return false; }
  Result<> do_open(const LineCameraConfig& config) override;
  std::optional<int> do_fewer_buffers() const override;
  Result<> do_start() override;
  Result<std::optional<LineFrame>> do_wait_frame(Duration timeout) override;
  void do_release(int buffer) override;
  void do_stop() override;
  void do_close() override;
  std::string do_identity() const override;
  CameraControls do_controls() const override;

  Result<std::string> find_node(const LineFormat& wanted) const;
  Result<> open_node(const std::string& node, const LineCameraConfig& config);
  tl::unexpected<Error> broken(std::string_view action, int error_number);
  LineFrame handed_out(const FetchedFrame& fetched, TimePoint now);
  void note(std::vector<std::string> words);

  const V4l2CameraOptions options_;
  Clock& clock_;

  LineCameraConfig config_;
  std::unique_ptr<CaptureNode> node_;
  std::unique_ptr<CaptureBuffers> buffers_; // unmapped before the node is closed
  std::string bus_;                         // of the last open
  std::size_t image_bytes_ = 0;             // of a frame, including what the driver appends
  bool clocks_differ_ = false;
  SequenceCounter sequence_;

  std::atomic<std::uint64_t> own_stamps_{0};
  std::atomic<std::uint64_t> failed_returns_{0};
  mutable std::mutex notes_mutex_; // never taken by the camera thread while streaming
  std::vector<std::string> notes_;
  std::string camera_; // of the last open
};

} // namespace octascope::hal::linux_backend
