// How far GL lags behind the submitted work.
#pragma once

#include <array>
#include <cstdint>

#include <GLES3/gl3.h>

namespace octascope::ui {

// A GPU queues work without doing it, so an unrestrained submitter would give it everything before
// the processor has begun. This holds the submitting thread back until at most two portions of
// batches are outstanding.
//
// Threads: as gl/objects.h.
class GpuPace {
public:
  GpuPace();
  GpuPace(const GpuPace&) = delete;
  GpuPace& operator=(const GpuPace&) = delete;
  ~GpuPace();

  // Call after submitting a batch. Does nothing where the processor is the GPU: drawing has then
  // taken its time already.
  void submitted();

private:
  bool paced_;
  std::uint32_t batches_ = 0;
  std::size_t next_ = 0;
  std::array<GLsync, 2> fences_{};
};

} // namespace octascope::ui
