// Names of methods and branches, and descriptions of what was drawn, for the command line.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/vessels/tree.h"
#include "ui/vessels/pictures/vessel_methods.h"
#include "ui/vessels/view/vessel_view.h"
#include "ui/view/segment_counts.h"

namespace octascope::firmware_host {

// "rca"; "unknown" if it belongs to no branch.
std::string_view to_string(pipeline::VesselBranch branch);

const std::map<std::string, pipeline::VesselBranch>& branches_by_name();
const std::map<std::string, ui::VesselColouring>& colourings_by_name();
const std::map<std::string, ui::BenchmarkView>& views_by_name();
std::vector<std::string> method_names();

// The names in such a map.
template <class Map> std::vector<std::string> names_of(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map)
    names.push_back(name);
  return names;
}

// "target 1.2,3.4,5.6 mm, 0.02 mm a pixel, yaw 35, tilt 15 degrees"
std::string describe(const ui::VesselView& view);
// "3 drawn by GL + 4 splatted + 0 merged + 5 culled = 12 segments"
std::string describe(const ui::SegmentCounts& account);

} // namespace octascope::firmware_host
