// The bricks of a volume that rays can leap over.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/threads/work_team.h"
#include "pipeline/volume/flow_marks.h"
#include "pipeline/volume/occupancy.h"
#include "ui/transfer/visible_levels.h"

namespace octascope::ui {

// What the picture shows, for deciding which bricks are empty.
enum class Visibility : std::uint8_t {
  range,     // a brick is empty if none of the levels in it is visible
  maximum,   // … if no level up to its highest is visible: for the maximum along a ray
  everything // no brick is empty
};

// Bricks in the order [b][a][depth]. Allocates when their number changes.
class BrickGrid {
public:
  // Shared among the team. `stale`: not 0 for rows along the slow axis to update, the others stay as
  // they are; empty: all. What is occupied in `also`, of the same counts and rows, is here, too.
  void update(const pipeline::Occupancy& occupancy, const VisibleLevels& levels,
              Visibility visibility, WorkTeam* team = nullptr,
              std::span<const std::uint8_t> stale = {}, const BrickGrid* also = nullptr);

  // Occupied are bricks in which something is seen to flow, or all. The highest level of those is 255, of
  // others 0.
  void update_flow(const pipeline::FlowMarks& flow, bool all, WorkTeam* team = nullptr,
                   std::span<const std::uint8_t> stale = {});

  const pipeline::BrickCounts& counts() const { return counts_; }
  std::span<const std::uint8_t> occupied() const { return occupied_; } // 0: empty; 1
  std::span<const std::uint8_t> highest() const { return highest_; }   // level
  double occupied_share() const { return occupied_share_; }

private:
  void resize(const pipeline::BrickCounts& counts);
  // Calls `update` with each row.
  template <class Update>
  void update_rows(const pipeline::BrickCounts& counts, WorkTeam* team,
                   std::span<const std::uint8_t> stale, Update update);
  void merge_flow(const pipeline::FlowMarks& flow, int row);
  void merge_b_scans(const pipeline::Occupancy& occupancy, int row);

  pipeline::BrickCounts counts_;
  std::vector<std::uint8_t> highest_;
  std::vector<std::uint8_t> lowest_;
  std::vector<std::uint8_t> occupied_;
  double occupied_share_ = 0;
};

} // namespace octascope::ui
