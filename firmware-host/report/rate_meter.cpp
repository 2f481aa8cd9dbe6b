#include "firmware-host/report/rate_meter.h"

namespace octascope::firmware_host {

void RateMeter::update(std::uint64_t total, hal::TimePoint now) {
  if (count_ > 0 && now - samples_[(count_ - 1) % window].time < spacing)
    return;
  samples_[count_ % window] = {total, now};
  ++count_;
  const Sample& oldest = samples_[count_ > window ? count_ % window : 0];
  const double seconds = hal::to_seconds(now - oldest.time);
  if (seconds > 0)
    rate_ = static_cast<double>(total - oldest.total) / seconds;
}

} // namespace octascope::firmware_host
