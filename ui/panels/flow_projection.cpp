#include "ui/panels/flow_projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>

#include "ui/transfer/flow_look.h"

namespace octascope::ui {

namespace {

constexpr int block = 16; // depths of which the highest is found by vectors alone

// At least as high where nothing is seen, as nearly everywhere.
std::uint8_t highest_of(const std::uint8_t* counts) {
  std::array<std::uint64_t, block / sizeof(std::uint64_t)> eights{};
  std::memcpy(eights.data(), counts, block);
  constexpr std::uint64_t highest_bits = 0x8080'8080'8080'8080;
  static_assert(first_seen_flow == 0x80);
  if (((eights[0] | eights[1]) & highest_bits) == 0)
    return first_seen_flow - 1;
  std::uint8_t highest = 0;
  for (int i = 0; i < block; ++i)
    highest = std::max(highest, counts[i]);
  return highest;
}

// Of what is too little to be seen nothing is found.
constexpr int unseen_sum = flow_run * (first_seen_flow - 1);

struct Strongest {
  int sum = unseen_sum;
  int from = 0;
};

// Of the runs that begin from there to before there.
void find_strongest(const std::uint8_t* counts, int from, int to, Strongest& strongest) {
  int sum = 0;
  for (int i = 0; i < flow_run; ++i)
    sum += counts[from + i];
  for (int at = from;; ++at) {
    if (sum > strongest.sum)
      strongest = {sum, at};
    if (at + 1 >= to)
      return;
    sum += counts[at + flow_run] - counts[at];
  }
}

// Nearly all blocks have too little to be looked at once more: a run has at most the mean of the
// highest in its block and in the next one.
ComingRuns::Run strongest_run(const std::uint8_t* counts, int from, int depths) {
  Strongest strongest;
  int at = from;
  std::uint8_t here = at + block <= depths ? highest_of(counts + at) : std::uint8_t{255};
  for (; at + 2 * block <= depths; at += block) {
    const std::uint8_t next = highest_of(counts + at + block);
    if (flow_run * std::max(here, next) > strongest.sum)
      find_strongest(counts, at, at + block, strongest);
    here = next;
  }
  if (at + flow_run <= depths)
    find_strongest(counts, at, depths - flow_run + 1, strongest);
  if (strongest.sum == unseen_sum)
    return {};
  return {static_cast<std::uint16_t>(strongest.from), static_cast<std::uint16_t>(strongest.sum)};
}

// Depths, from the first one to before the last one.
struct Depths {
  int from = 0;
  int to = 0;
};

// Of four A-scans, where their marks, a row of words, leave room for a run.
Depths depths_to_search(std::span<const std::uint32_t> marks, int depths) {
  constexpr int bins_of_word = 8;
  const auto is_marked = [](std::uint32_t word) { return word != 0; };
  const auto first = std::ranges::find_if(marks, is_marked);
  if (first == marks.end())
    return {};
  const auto last = std::find_if(marks.rbegin(), marks.rend(), is_marked);
  const int marked_from = static_cast<int>(first - marks.begin()) * bins_of_word;
  const int marked_to = static_cast<int>(marks.rend() - last) * bins_of_word;
  return {std::max(marked_from - flow_run, 0), std::min(marked_to + flow_run, depths)};
}

// Calls visit(a, its counts, where to search them) for the A-scans of a B-scan.
template <class Visit> void for_a_scans(const pipeline::Volume& volume, int b, const Visit& visit) {
  const pipeline::VolumeGeometry& geometry = volume.geometry;
  const pipeline::FlowMarks& marks = volume.flow_marks;
  const std::uint8_t* counts = volume.b_scan_flow(b).data();
  Depths search{0, geometry.depths};
  for (int a = 0; a < geometry.a_scans; ++a, counts += geometry.depths) {
    if (!marks.empty() && a % 4 == 0)
      search = depths_to_search(marks.of(b).subspan(static_cast<std::size_t>(a / 4 * marks.row()),
                                                    static_cast<std::size_t>(marks.row())),
                                geometry.depths);
    visit(a, counts, search);
  }
}

FlowFromAbove flow_of(const ComingRuns::Run& run, int surface, int depths) {
  if (run.sum == 0)
    return {};
  const int strength = (run.sum + flow_run / 2) / flow_run;
  const int below = run.from + flow_run / 2 - surface;
  return {static_cast<std::uint8_t>(strength),
          static_cast<std::uint8_t>((strength * below + depths / 2) / depths)};
}

constexpr std::size_t depth_bins = 256;

// What flows, by its depth as a share of the volume's.
std::array<int, depth_bins> depths_of(std::span<const FlowFromAbove> flow) {
  std::array<int, depth_bins> found{};
  for (const FlowFromAbove& each : flow)
    if (each.strength > 0)
      ++found[each.strength_by_depth * (depth_bins - 1) / each.strength];
  return found;
}

double next_step_mm(double step_mm) {
  const double power = std::pow(10.0, std::floor(std::log10(step_mm * 1.01)));
  const double digit = step_mm / power;
  return power * (digit < 1.5 ? 2 : digit < 3 ? 5 : 10);
}

} // namespace

void ComingRuns::bring(const pipeline::Volume& coming, std::uint64_t number, int finished) {
  const auto a_scans = static_cast<std::size_t>(coming.geometry.a_scans);
  if (volume_ != &coming || number_ != number) {
    volume_ = &coming;
    number_ = number;
    brought_ = 0;
    runs_.resize(a_scans * static_cast<std::size_t>(coming.geometry.b_scans));
  }
  for (; brought_ < finished; ++brought_) {
    const std::span<Run> runs =
        std::span{runs_}.subspan(static_cast<std::size_t>(brought_) * a_scans, a_scans);
    for_a_scans(coming, brought_, [&](int a, const std::uint8_t* counts, const Depths& search) {
      runs[static_cast<std::size_t>(a)] = strongest_run(counts, search.from, search.to);
    });
  }
}

std::span<const ComingRuns::Run> ComingRuns::of(const pipeline::Volume& volume) const {
  if (volume_ != &volume || number_ != volume.metadata.index)
    return {};
  return std::span{runs_}.first(static_cast<std::size_t>(brought_) *
                                static_cast<std::size_t>(volume.geometry.a_scans));
}

void FlowDepths::follow(std::span<const FlowFromAbove> flow, double volume_depth_mm) {
  constexpr double least_mm = 0.1;
  constexpr double most_below = 0.05; // of what flows, and of so little that it may shrink:
  constexpr double hardly_any = 0.01;
  const auto found = depths_of(flow);
  const double all = std::accumulate(found.begin(), found.end(), 0);
  if (all == 0)
    return;
  const auto share_below = [&](double mm) {
    const auto from = static_cast<std::size_t>(
        std::min(mm / volume_depth_mm * static_cast<double>(depth_bins - 1), 255.0));
    return std::accumulate(found.begin() + static_cast<std::ptrdiff_t>(from), found.end(), 0) / all;
  };
  double needed = least_mm;
  const double most = deepest_mm_ > 0 ? hardly_any : most_below;
  while (needed < volume_depth_mm && share_below(needed) > most)
    needed = next_step_mm(needed);
  if (needed < deepest_mm_ || deepest_mm_ == 0) {
    deepest_mm_ = needed;
    return;
  }
  while (deepest_mm_ < volume_depth_mm && share_below(deepest_mm_) > most_below)
    deepest_mm_ = next_step_mm(deepest_mm_);
}

void project_flow(const pipeline::Volume& volume, const TissueMap& tissue,
                  std::span<FlowFromAbove> out, std::span<const std::uint8_t> wanted,
                  std::span<const ComingRuns::Run> ahead, WorkTeam* team) {
  const pipeline::VolumeGeometry& geometry = volume.geometry;
  const auto a_scans = static_cast<std::size_t>(geometry.a_scans);
  run_pieces(team, static_cast<std::uint32_t>(geometry.b_scans), [&](std::uint32_t piece) {
    if (!wanted.empty() && wanted[piece] == 0)
      return;
    const int b = static_cast<int>(piece);
    const std::size_t first = piece * a_scans;
    for_a_scans(volume, b, [&](int a, const std::uint8_t* counts, const Depths& search) {
      const std::size_t i = first + static_cast<std::size_t>(a);
      const int surface = tissue.begin_of(b, a).depth;
      // The strongest of all is that of the tissue if it lies in it.
      const bool known = i < ahead.size() && (ahead[i].sum == 0 || ahead[i].from >= surface);
      const ComingRuns::Run run =
          known ? ahead[i] : strongest_run(counts, std::max(surface, search.from), search.to);
      out[i] = flow_of(run, surface, geometry.depths);
    });
  });
}

} // namespace octascope::ui
