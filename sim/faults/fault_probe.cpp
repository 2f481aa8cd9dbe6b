#include "sim/faults/fault_probe.h"

#include <algorithm>

#include "sim/faults/fault_random.h"

namespace octascope::sim {

FaultProbe::FaultProbe(const FaultSchedule* schedule, pipeline::Device device)
    : schedule_(schedule), gone_(gone(device)),
      tallies_(schedule == nullptr ? 0 : schedule->faults().size()) {}

bool FaultProbe::pulled_since_last_look(hal::TimePoint now) {
  if (schedule_ == nullptr)
    return false;
  const bool pulled = unplugged(now) || schedule_->began_within(gone_, looked_, now);
  looked_ = now;
  return pulled;
}

const ScriptedFault* FaultProbe::strike(pipeline::Fault kind, hal::TimePoint t) {
  const ScriptedFault* striking = nullptr;
  for (std::size_t i = 0; i < tallies_.size(); ++i) {
    const ScriptedFault& fault = schedule_->faults()[i];
    if (fault.kind != kind)
      continue;
    const auto occurrence = schedule_->occurrence(fault, t);
    if (!occurrence)
      continue;
    Tally& tally = tallies_[i];
    if (tally.occurrence != occurrence->index)
      tally = Tally{.occurrence = occurrence->index};
    ++tally.seen;
    if ((fault.count > 0 && tally.hit >= fault.count) || !chooses(fault, tally))
      continue;
    ++tally.hit;
    if (striking == nullptr)
      striking = &fault;
  }
  return striking;
}

bool FaultProbe::chooses(const ScriptedFault& fault, const Tally& tally) {
  if (tally.seen % static_cast<std::uint64_t>(fault.every) != 0)
    return false;
  const std::uint64_t number = mixed(fault.seed ^ mixed(tally.occurrence) ^ tally.seen);
  return even_number(number) < fault.probability;
}

bool FaultProbe::expects(pipeline::Fault kind) const {
  return schedule_ != nullptr &&
         std::any_of(schedule_->faults().begin(), schedule_->faults().end(),
                     [&](const ScriptedFault& f) { return f.kind == kind; });
}

} // namespace octascope::sim
