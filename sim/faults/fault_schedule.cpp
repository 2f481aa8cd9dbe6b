#include "sim/faults/fault_schedule.h"

#include <algorithm>

namespace octascope::sim {

using hal::Duration;
using hal::TimePoint;
using pipeline::Fault;

std::optional<FaultOccurrence> FaultSchedule::occurrence(const ScriptedFault& fault,
                                                         TimePoint t) const {
  const std::int64_t zero_ns = zero_ns_.load(std::memory_order_acquire);
  if (zero_ns == not_started)
    return std::nullopt;
  const TimePoint first = TimePoint{Duration{zero_ns}} + fault.at;
  if (t < first)
    return std::nullopt;
  const std::int64_t index = fault.repeat > Duration{} ? (t - first) / fault.repeat : 0;
  const TimePoint began = first + index * fault.repeat;
  if (fault.duration > Duration{} && t - began >= fault.duration)
    return std::nullopt;
  return FaultOccurrence{static_cast<std::uint64_t>(index), began};
}

const ScriptedFault* FaultSchedule::find_active(Fault kind, TimePoint t, int switch_index) const {
  const auto found = std::find_if(faults().begin(), faults().end(), [&](const ScriptedFault& f) {
    const bool concerned = switch_index < 0 || f.switch_index < 0 || f.switch_index == switch_index;
    return f.kind == kind && concerned && occurrence(f, t).has_value();
  });
  return found == faults().end() ? nullptr : &*found;
}

std::optional<FaultEdge> FaultSchedule::next_edge_of(const ScriptedFault& fault,
                                                     TimePoint after) const {
  const std::int64_t zero_ns = zero_ns_.load(std::memory_order_acquire);
  if (zero_ns == not_started)
    return std::nullopt;
  const TimePoint first = TimePoint{Duration{zero_ns}} + fault.at;
  if (after < first)
    return FaultEdge{first, &fault, true};
  const std::int64_t index = fault.repeat > Duration{} ? (after - first) / fault.repeat : 0;
  const TimePoint began = first + index * fault.repeat;
  if (fault.duration > Duration{} && began + fault.duration > after)
    return FaultEdge{began + fault.duration, &fault, false};
  if (fault.repeat > Duration{})
    return FaultEdge{began + fault.repeat, &fault, true};
  return std::nullopt;
}

std::optional<TimePoint> FaultSchedule::next_edge(Fault kind, TimePoint after) const {
  std::optional<TimePoint> next;
  for (const ScriptedFault& fault : faults()) {
    if (fault.kind != kind)
      continue;
    if (const auto edge = next_edge_of(fault, after))
      next = next ? std::min(*next, edge->time) : edge->time;
  }
  return next;
}

bool FaultSchedule::began_within(Fault kind, TimePoint after, TimePoint until) const {
  return std::any_of(faults().begin(), faults().end(), [&](const ScriptedFault& fault) {
    if (fault.kind != kind)
      return false;
    auto edge = next_edge_of(fault, after);
    if (edge && !edge->begins)
      edge = next_edge_of(fault, edge->time);
    return edge && edge->time <= until;
  });
}

std::size_t FaultSchedule::edges_within(TimePoint after, TimePoint until,
                                        std::span<FaultEdge> edges) const {
  std::size_t written = 0;
  const auto insert = [&](const FaultEdge& edge) {
    const auto end = edges.begin() + static_cast<std::ptrdiff_t>(written);
    const auto place = std::find_if(edges.begin(), end,
                                    [&](const FaultEdge& other) { return other.time > edge.time; });
    if (place == edges.end())
      return false;
    written = std::min(written + 1, edges.size());
    std::move_backward(place, edges.begin() + static_cast<std::ptrdiff_t>(written) - 1,
                       edges.begin() + static_cast<std::ptrdiff_t>(written));
    *place = edge;
    return true;
  };
  for (const ScriptedFault& fault : faults()) {
    auto edge = next_edge_of(fault, after);
    while (edge && edge->time <= until && insert(*edge))
      edge = next_edge_of(fault, edge->time);
  }
  return written;
}

} // namespace octascope::sim
