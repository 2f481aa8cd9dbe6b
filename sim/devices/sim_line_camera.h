// The twin of the line camera: B-scans of a SpectraSource, at the true line rate, after each pulse
// of the trigger's twin.
//
// Frame f of a sweep that starts at T is exposed from T + f·L/rate to T + (f+1)·L/rate (L lines a
// frame) and delivered no earlier than its end. A frame belongs to the stream if its exposure began
// at or after start(): a camera started during a sweep begins in its middle.
//
// The driver is modelled, too: it has config.buffers frames, on loan or waiting; frames that find
// none free are dropped and show as a gap in the sequence. Buffers are checked when wait_frame() is
// called, so one given back before the call counts as free.
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

// What the twin has done, to compare with what the program noticed.
struct LineCameraTally {
  std::uint64_t made = 0;      // frames exposed while streaming
  std::uint64_t delivered = 0; // frames handed out
  std::uint64_t dropped_by_fault = 0;
  std::uint64_t dropped_without_buffer = 0;
  std::uint64_t altered = 0; // delivered corrupted, with a wrong size, or saturated
};

// Default identity() of the twin.
inline constexpr std::string_view simulated_camera = "simulated spectrometer";

class SimLineCamera final : public hal::LineCamera {
public:
  // Everything borrowed must outlive the camera; `faults` may be null. `identity`: which camera it
  // is until the fault script replaces it; empty: unknown.
  SimLineCamera(const SpectraSource& source, GalvoLink& link, hal::Clock& clock,
                const FaultSchedule* faults = nullptr, ScanMotion motion = {},
                std::string identity = std::string{simulated_camera});

  // Thread-safe.
  LineCameraTally tally() const;

private:
  // A frame held by the driver until it is fetched.
  struct WaitingFrame {
    int buffer = -1;
    std::span<const std::byte> bytes; // in the source
    std::uint64_t sequence = 0;
    hal::TimePoint first_line;
    hal::TimePoint last_line;
    hal::TimePoint ready; // when the driver delivers it
    std::uint64_t noise_seed = 0;
    const ScriptedFault* corrupted = nullptr;
    const ScriptedFault* wrong_size = nullptr;
    const ScriptedFault* saturated = nullptr;
  };

  // The frame that the hardware exposes next.
  struct Exposure {
    std::uint64_t sweep = 0;
    int in_volume = 0; // index of the frame in it
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
  hal::Result<> wrong_state(std::string_view call, std::string_view expected) const;
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
  std::vector<WaitingFrame> waiting_; // a ring of config_.buffers places
  std::size_t oldest_waiting_ = 0;
  std::size_t waiting_count_ = 0;
  std::size_t scratch_bytes_ = 0; // of one buffer; 0 unless faults alter bytes
  std::unique_ptr<std::byte[]> scratch_;

  hal::TimePoint started_;
  std::uint64_t next_sweep_ = 0;
  int next_in_volume_ = 0;
  std::uint64_t next_sequence_ = 0;
  std::uint64_t shown_sequence_ = 0; // of the newest frame, as reported by the driver

  std::string plugged_in_;            // the camera that is plugged in
  mutable std::mutex identity_mutex_; // guards the identity
  std::string identity_;

  std::atomic<std::uint64_t> made_{0};
  std::atomic<std::uint64_t> delivered_{0};
  std::atomic<std::uint64_t> dropped_by_fault_{0};
  std::atomic<std::uint64_t> dropped_without_buffer_{0};
  std::atomic<std::uint64_t> altered_{0};
};

} // namespace octascope::sim
