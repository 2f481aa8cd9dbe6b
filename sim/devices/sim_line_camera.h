// The simulated line camera: delivers B-scans of a SpectraSource at the true line rate whenever the
// simulated galvo trigger was pulsed.
//
// Frame f of a sweep that starts at T is exposed from T + f·L/rate to T + (f+1)·L/rate (L lines per
// frame) and delivered no earlier than its end. Frames whose exposure began at or after start()
// belong to the stream: a camera started in the middle of a sweep begins in its middle.
//
// The driver is simulated too: it has config.buffers frames, on loan or waiting; frames that arrive
// when all are taken are dropped, which leaves a gap in the sequence. It checks the buffers when
// wait_frame() is called, so one given back before the call counts as free.
//
// Bytes are not copied but point into the source, unless a fault alters them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "hal/line_camera.h"
#include "sim/devices/frame_loans.h"
#include "sim/devices/galvo_link.h"
#include "sim/faults/fault_probe.h"
#include "sim/spectra/scan_motion.h"
#include "sim/spectra/spectra_source.h"

namespace octascope::sim {

// What the camera did since construction, to compare with what the program noticed.
struct LineCameraTally {
  std::uint64_t made = 0;      // frames that the hardware exposed while streaming
  std::uint64_t delivered = 0; // frames handed out
  std::uint64_t dropped_by_fault = 0;
  std::uint64_t dropped_without_buffer = 0;
  std::uint64_t altered = 0; // delivered corrupted, in the wrong size, or saturated
};

// The default identity().
inline constexpr std::string_view simulated_camera = "simulated spectrometer";

class SimLineCamera final : public hal::LineCamera {
public:
  // All borrowed objects must outlive the camera; `faults` may be null. `identity`: the camera's
  // identity until the fault script replaces it; empty if unknown.
  SimLineCamera(const SpectraSource& source, GalvoLink& link, hal::Clock& clock,
                const FaultSchedule* faults = nullptr, ScanMotion motion = {},
                std::string identity = std::string{simulated_camera});

  // Thread-safe.
  LineCameraTally tally() const;

private:
  // A frame that the driver holds until it is fetched.
  struct WaitingFrame {
    int buffer = -1;
    std::span<const std::byte> bytes; // of the source
    std::uint64_t sequence = 0;
    hal::TimePoint first_line;
    hal::TimePoint last_line;
    hal::TimePoint ready; // when the driver delivers it
    std::uint64_t noise_seed = 0;
    const ScriptedFault* corrupted = nullptr;
    const ScriptedFault* wrong_size = nullptr;
    const ScriptedFault* saturated = nullptr;
  };

  // The next exposure of the hardware.
  struct Exposure {
    std::uint64_t sweep = 0;
    int in_volume = 0; // index of the frame in its volume
    hal::TimePoint begin;
    hal::TimePoint end;
  };

  std::string_view do_backend() const override { return "sim"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open(const hal::LineCameraConfig& config) override;
  hal::Result<> do_start() override;
  hal::Result<std::optional<hal::LineFrame>> do_wait_frame(hal::Duration timeout) override;
  void do_release(int buffer) override { loans_.give_back(buffer); }
  void do_stop() override;
  void do_close() override;
  std::string do_identity() const override;

  hal::Result<> check(const hal::LineCameraConfig& config) const;
  hal::Error disconnect();
  void look_what_is_plugged_in(hal::TimePoint now);
  void allocate_buffers();

  hal::Duration line_offset(std::int64_t line) const;
  std::optional<Exposure> next_exposure();
  void step_exposure();
  void expose_until(hal::TimePoint now);
  void finish(const Exposure& exposure);
  void discard_waiting();
  hal::LineFrame hand_out(const WaitingFrame& frame);
  std::span<const std::byte> altered_bytes(const WaitingFrame& frame);
  hal::TimePoint next_look(hal::TimePoint now, hal::TimePoint deadline);

  const SpectraSource& source_;
  GalvoLink& link_;
  hal::Clock& clock_;
  const ScanMotion motion_;
  FaultProbe probe_;

  hal::LineCameraConfig config_;
  FrameLoans loans_;
  std::vector<WaitingFrame> waiting_; // a ring of config_.buffers entries
  std::size_t oldest_waiting_ = 0;
  std::size_t waiting_count_ = 0;
  std::size_t scratch_bytes_ = 0; // per buffer; 0 without faults that alter bytes
  std::unique_ptr<std::byte[]> scratch_;

  hal::TimePoint started_;
  std::uint64_t next_sweep_ = 0;
  int next_in_volume_ = 0;
  std::uint64_t next_sequence_ = 0;
  std::uint64_t shown_sequence_ = 0; // of the newest frame, as reported by the driver

  std::string plugged_in_;            // identity of the plugged-in camera
  mutable std::mutex identity_mutex_; // guards identity_
  std::string identity_;

  std::atomic<std::uint64_t> made_{0};
  std::atomic<std::uint64_t> delivered_{0};
  std::atomic<std::uint64_t> dropped_by_fault_{0};
  std::atomic<std::uint64_t> dropped_without_buffer_{0};
  std::atomic<std::uint64_t> altered_{0};
};

} // namespace octascope::sim
