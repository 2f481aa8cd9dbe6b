// A volume's way from its last line to the glass, stage by stage.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "hal/clock.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/volume/volume.h"
#include "ui/status/timing.h"

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

// What happened to a volume on its way, where.
struct PassageEvent {
  ui::TimingBar bar;
  std::string_view name; // must be a literal; empty: a B-scan was made
  std::size_t b_scan = 0;
};

// Calls `each(const PassageEvent&)` for all of them. `works`: of the volume's B-scans.
template <class Each>
void for_each_event(const pipeline::VolumeMetadata& m, std::span<const pipeline::BScanWork> works,
                    const Showing& showing, Each&& each) {
  using enum ui::TimingRow;
  const auto event = [&](ui::TimingRow row, std::string_view name, bool waits, hal::TimePoint begin,
                         hal::TimePoint end) {
    each(PassageEvent{{begin, std::max(begin, end), row, waits}, name});
  };
  event(exposure, "exposure", false, m.first_line, m.last_line);
  event(camera, name_of(Stage::fetch), false, m.last_line, m.fetched);
  event(camera, name_of(Stage::queue), true, m.fetched, m.placed);
  for (std::size_t b = 0; b < works.size(); ++b)
    if (const pipeline::BScanWork& work = works[b]; work.end != hal::TimePoint{})
      each(PassageEvent{{work.begin, work.end, workers, false, work.worker}, {}, b});
  event(fixed_rate, name_of(Stage::assemble), false, m.published - m.assemble, m.published);
  event(buffer, name_of(Stage::wait), true, m.published, showing.taken);
  event(render, name_of(Stage::upload), false, showing.taken, showing.uploaded);
  event(render, name_of(Stage::draw), false, showing.uploaded, showing.drawn);
  event(glass, name_of(Stage::flip), true, showing.drawn, showing.flipped);
}

using StageStatistics = std::array<pipeline::DurationStatistics, stage_count>;

} // namespace octascope::firmware_host
