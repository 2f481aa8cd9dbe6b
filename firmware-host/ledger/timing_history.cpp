#include "firmware-host/ledger/timing_history.h"

#include <algorithm>

namespace octascope::firmware_host {

namespace {

constexpr std::size_t bars_besides_b_scans = 8;

} // namespace

TimingHistory::TimingHistory(int b_scans) {
  for (ui::TimedVolume& volume : timing_.volumes)
    volume.bars.reserve(static_cast<std::size_t>(b_scans) + bars_besides_b_scans);
}

void TimingHistory::add(const pipeline::Volume& volume, const Showing& showing) {
  ui::TimedVolume& oldest = timing_.volumes[next_];
  next_ = (next_ + 1) % timing_.volumes.size();
  oldest.index = timing_.newest = volume.metadata.index;
  oldest.last_line = volume.metadata.last_line;
  oldest.flipped = showing.flipped;
  oldest.bars.clear();
  for_each_event(volume.metadata, volume.work, showing, [&](const PassageEvent& event) {
    oldest.bars.push_back(event.bar);
    timing_.workers = std::max(timing_.workers, event.bar.worker + 1);
  });
}

} // namespace octascope::firmware_host
