// How far GL lags behind what was submitted to it.
#pragma once

#include <array>
#include <cstdint>

#include <GLES3/gl3.h>

namespace octascope::ui {

// A GPU takes work without doing it: who submits all he can has given it everything before the
// processor has begun. This holds the submitting thread back until the GPU has caught up but for
// two portions.
//
// Threads: as gl/objects.h.
class GpuPace {
public:
  GpuPace();
  GpuPace(const GpuPace&) = delete;
  GpuPace& operator=(const GpuPace&) = delete;
  ~GpuPace();

  // A batch was submitted. Where the processor is the GPU, drawing has cost its time by now, and
  // this does nothing.
  void submitted();

private:
  bool paced_;
  std::uint32_t batches_ = 0;
  std::size_t next_ = 0;
  std::array<GLsync, 2> fences_{};
};

} // namespace octascope::ui
