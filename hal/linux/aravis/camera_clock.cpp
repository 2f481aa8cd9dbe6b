#include "hal/linux/aravis/camera_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octascope::hal::linux_backend {

using namespace std::chrono_literals;

namespace {

constexpr Duration longest_behind = 3s;
constexpr Duration longest_unfit = 5s;
constexpr Duration longest_counted = 1s; // more is a pause, which tells nothing of stamps
constexpr double farthest_ns = 1e9;      // from one frame to the next

} // namespace

TimePoint CameraClock::end_of_frame(std::uint64_t stamp_ns, TimePoint arrival) {
  const auto end = from_stamp(stamp_ns, arrival);
  note_use(end.has_value(), arrival);
  return fits_ && end ? std::min(*end, arrival) : arrival;
}

void CameraClock::note_use(bool of_use, TimePoint arrival) {
  const Duration passed = arrival - std::exchange(last_arrival_, arrival).value_or(arrival);
  const Duration counted = passed > longest_counted ? Duration{} : std::max(passed, Duration{});
  unfit_ = std::clamp(of_use ? unfit_ - counted : unfit_ + counted, Duration{}, longest_unfit);
  if (unfit_ == longest_unfit)
    fits_ = false;
  else if (unfit_ == Duration{})
    fits_ = true;
}

std::optional<TimePoint> CameraClock::from_stamp(std::uint64_t stamp_ns, TimePoint arrival) {
  constexpr std::uint64_t most_ns = 1ULL << 62; // 146 years, and far from an overflow
  if (stamp_ns == 0 || stamp_ns > most_ns || (vertices_ > 0 && stamp_ns <= last_stamp_ns_)) {
    vertices_ = 0;
    return std::nullopt;
  }
  last_stamp_ns_ = stamp_ns;
  const Duration stamp{static_cast<Duration::rep>(stamp_ns)};
  const Duration distance = arrival.time_since_epoch() - stamp;
  if (vertices_ > 0) {
    const Point point{static_cast<double>(stamp_ns - first_stamp_ns_),
                      static_cast<double>((distance - first_distance_).count())};
    if (has_leapt(point, arrival))
      vertices_ = 0;
    else
      add(point);
  }
  if (vertices_ == 0) {
    first_stamp_ns_ = stamp_ns;
    first_distance_ = distance;
    behind_since_.reset();
    add({});
    return std::nullopt; // there is nothing to compare it with
  }
  const auto known = rate();
  if (!known)
    return std::nullopt;
  const double best = distance_at(last().stamp_ns, *known);
  return TimePoint{stamp + first_distance_ + Duration{std::llround(best)}};
}

// Of a clock that fits, no frame comes before its time, and not all of them late.
bool CameraClock::has_leapt(const Point& point, TimePoint arrival) {
  if (std::abs(point.distance_ns - last().distance_ns) > farthest_ns)
    return true;
  const auto known = rate();
  if (!known) {
    behind_since_.reset();
    return false;
  }
  const double late = point.distance_ns - distance_at(point.stamp_ns, *known);
  if (late < most_difference_ns)
    behind_since_.reset();
  else if (!behind_since_)
    behind_since_ = arrival;
  const double least =
      span_ns() < learning_ns ? -most_drift : *known; // the rate, as far as is known
  return point.distance_ns - distance_at(point.stamp_ns, least) < -most_difference_ns ||
         (behind_since_ && arrival - *behind_since_ > longest_behind);
}

void CameraClock::add(const Point& point) {
  const auto lies_above = [&](const Point& from, const Point& between) {
    return (between.distance_ns - from.distance_ns) * (point.stamp_ns - from.stamp_ns) >=
           (point.distance_ns - from.distance_ns) * (between.stamp_ns - from.stamp_ns);
  };
  while (vertices_ >= 2 && lies_above(hull_[vertices_ - 2], last()))
    --vertices_;
  if (vertices_ == hull_.size()) { // every other one tells nearly the same
    for (std::size_t i = 1; i < vertices_ / 2; ++i)
      hull_[i] = hull_[2 * i];
    vertices_ /= 2;
  }
  hull_[vertices_++] = point;
  forget_old();
}

// The hull is cut off where its memory ends, within an edge.
void CameraClock::forget_old() {
  const double oldest_ns = last().stamp_ns - memory_ns;
  std::size_t gone = 0;
  while (gone + 1 < vertices_ && hull_[gone + 1].stamp_ns <= oldest_ns)
    ++gone;
  std::copy(hull_.begin() + static_cast<std::ptrdiff_t>(gone),
            hull_.begin() + static_cast<std::ptrdiff_t>(vertices_), hull_.begin());
  vertices_ -= gone;
  if (vertices_ < 2 || hull_[0].stamp_ns >= oldest_ns)
    return;
  const double slope =
      (hull_[1].distance_ns - hull_[0].distance_ns) / (hull_[1].stamp_ns - hull_[0].stamp_ns);
  hull_[0].distance_ns += slope * (oldest_ns - hull_[0].stamp_ns);
  hull_[0].stamp_ns = oldest_ns;
}

// By how much the distance grows with the camera's time; none: by more than a camera's clock may. Ends
// of long edges are prompt frames: late ones near the hull's ends have short edges.
std::optional<double> CameraClock::rate() const {
  const auto too_far = [](const Point& way) {
    return std::abs(way.distance_ns) > most_drift * way.stamp_ns + most_difference_ns;
  };
  const auto way = [&](std::size_t from, std::size_t to) {
    return Point{hull_[to].stamp_ns - hull_[from].stamp_ns,
                 hull_[to].distance_ns - hull_[from].distance_ns};
  };
  Point longest;
  for (std::size_t i = 1; i < vertices_; ++i)
    if (const Point edge = way(i - 1, i); edge.stamp_ns > longest.stamp_ns)
      longest = edge;
  std::size_t begin = vertices_;
  std::size_t end = 0;
  for (std::size_t i = 1; i < vertices_; ++i)
    if (4 * way(i - 1, i).stamp_ns >= longest.stamp_ns) {
      begin = std::min(begin, i - 1);
      end = i;
    }
  if (end > 0 && too_far(way(begin, end)))
    return std::nullopt;
  return span_ns() < learning_ns
             ? most_drift
             : std::clamp(longest.distance_ns / longest.stamp_ns, -most_drift, most_drift);
}

// The highest line of this rate that is above no point.
double CameraClock::distance_at(double stamp_ns, double rate) const {
  double lowest = hull_[0].distance_ns + rate * (stamp_ns - hull_[0].stamp_ns);
  for (std::size_t i = 1; i < vertices_; ++i)
    lowest = std::min(lowest, hull_[i].distance_ns + rate * (stamp_ns - hull_[i].stamp_ns));
  return lowest;
}

} // namespace octascope::hal::linux_backend
