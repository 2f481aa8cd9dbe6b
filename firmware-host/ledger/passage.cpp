#include "firmware-host/ledger/passage.h"

namespace octascope::firmware_host {

std::string_view name_of(Stage stage) {
  switch (stage) {
  case Stage::fetch: return "fetch";
  case Stage::queue: return "queue";
  case Stage::reconstruct: return "reconstruct";
  case Stage::assemble: return "assemble";
  case Stage::wait: return "wait";
  case Stage::upload: return "upload";
  case Stage::draw: return "draw";
  case Stage::flip: return "flip";
  }
  return "";
}

std::array<hal::Duration, stage_count> stages_of(const pipeline::VolumeMetadata& m,
                                                 const Showing& showing) {
  const std::array<hal::TimePoint, stage_count + 1> times{
      m.last_line,   m.fetched,        m.placed,      m.built,        m.published,
      showing.taken, showing.uploaded, showing.drawn, showing.flipped};
  std::array<hal::Duration, stage_count> lengths;
  for (std::size_t i = 0; i < stage_count; ++i)
    lengths[i] = times[i + 1] - times[i];
  return lengths;
}

} // namespace octascope::firmware_host
