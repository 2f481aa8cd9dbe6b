// A volume's way from its last line to the glass, stage by stage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hal/clock.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/volume/volume_metadata.h"

namespace octascope::firmware_host {

// In their order. Each begins where the one before ends; together they are the latency.
enum class Stage : std::uint8_t {
  fetch,       // until the camera thread has the last frame: transfer and driver
  queue,       // until the fixed-rate thread has placed it
  reconstruct, // until the last B-scan is made
  assemble,    // until the volume is published
  wait,        // until the render thread takes it
  upload,      // until the renderer has it
  draw,        // until its first frame is drawn
  flip,        // until that frame is on the glass
};
inline constexpr std::size_t stage_count = 8;
std::string_view name_of(Stage stage);

// What the render thread knows of a volume, besides its metadata.
struct Showing {
  hal::TimePoint taken, uploaded, drawn, flipped;
};

// Lengths of all stages, by Stage.
std::array<hal::Duration, stage_count> stages_of(const pipeline::VolumeMetadata& metadata,
                                                 const Showing& showing);

using StageStatistics = std::array<pipeline::DurationStatistics, stage_count>;

} // namespace octascope::firmware_host
