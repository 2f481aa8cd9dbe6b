// Limits how far GL lags behind the submitted work.
#pragma once

#include <array>
#include <cstdint>

#include <GLES3/gl3.h>

namespace octascope::ui {

// A GPU queues work without executing it, so a fast submitter could hand it everything before the
// processor has taken its share. This blocks the submitting thread until the GPU is at most two
// portions of several batches behind.
//
// Threads: as gl/objects.h.
class GpuPace {
public:
  GpuPace();
  GpuPace(const GpuPace&) = delete;
  GpuPace& operator=(const GpuPace&) = delete;
  ~GpuPace();

  // To be called after submitting a batch. Does nothing with software GL, where drawing is already
  // done by then.
  void submitted();

private:
  bool paced_;
  std::uint32_t batches_ = 0;
  std::size_t next_ = 0;
  std::array<GLsync, 2> fences_{};
};

} // namespace octascope::ui
