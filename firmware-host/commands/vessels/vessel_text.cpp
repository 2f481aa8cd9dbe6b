#include "firmware-host/commands/vessels/vessel_text.h"

#include <fmt/format.h>

namespace octascope::firmware_host {

using pipeline::VesselBranch;
using ui::VesselColouring;

std::string_view to_string(VesselBranch branch) {
  switch (branch) {
  case VesselBranch::rca: return "rca";
  case VesselBranch::lad: return "lad";
  case VesselBranch::lcx: return "lcx";
  case VesselBranch::unknown: break;
  }
  return "unknown";
}

const std::map<std::string, VesselBranch>& branches_by_name() {
  static const std::map<std::string, VesselBranch> all{
      {"rca", VesselBranch::rca}, {"lad", VesselBranch::lad}, {"lcx", VesselBranch::lcx}};
  return all;
}

const std::map<std::string, VesselColouring>& colourings_by_name() {
  static const std::map<std::string, VesselColouring> all{
      {"branch", VesselColouring::branch},
      {"order", VesselColouring::order},
      {"diagnostic", VesselColouring::diagnostic}};
  return all;
}

const std::map<std::string, ui::BenchmarkView>& views_by_name() {
  static const std::map<std::string, ui::BenchmarkView> all = [] {
    std::map<std::string, ui::BenchmarkView> made;
    for (const ui::BenchmarkView view : ui::all_benchmark_views)
      made.emplace(to_string(view), view);
    return made;
  }();
  return all;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const ui::VesselMethodKind kind : ui::all_vessel_methods)
    names.emplace_back(to_string(kind));
  return names;
}

std::string describe(const ui::VesselView& view) {
  return fmt::format("target {:.3f},{:.3f},{:.3f} mm, {:g} mm a pixel, yaw {:g}, tilt {:g} degrees",
                     view.target_mm.x, view.target_mm.y, view.target_mm.z, view.mm_per_pixel,
                     view.yaw_deg, view.tilt_deg);
}

std::string describe(const ui::SegmentCounts& account) {
  return fmt::format("{} drawn by GL + {} splatted + {} merged + {} culled = {} segments",
                     account.drawn, account.splatted, account.merged, account.culled,
                     account.total());
}

} // namespace octascope::firmware_host
