#include "firmware-host/commands/vessels/morphometry_json.h"

#include <array>

namespace octascope::firmware_host {

using nlohmann::ordered_json;

namespace {

ordered_json json_of(const sim::Comparison& c) {
  return {{"achieved", c.achieved},
          {"achieved_sd", c.achieved_deviation},
          {"published", c.published},
          {"published_deviation", c.published_deviation},
          {"z", c.z}};
}

} // namespace

ordered_json morphometry_json(const sim::MorphometryTable& table) {
  static constexpr std::array<const char*, 3> names{"RCA", "LAD", "LCX"};
  ordered_json rows = ordered_json::array();
  for (std::size_t b = 0; b < names.size(); ++b)
    for (std::size_t order = table.branches[b].size(); order-- > 0;) {
      const sim::OrderComparison& o = table.branches[b][order];
      if (!o.present)
        continue;
      rows.push_back({{"branch", names[b]},
                      {"order", order},
                      {"segments", o.segments},
                      {"factor", o.factor},
                      {"diameter_um", json_of(o.diameter_um)},
                      {"length_mm", json_of(o.length_mm)},
                      {"segments_per_element", json_of(o.segments_per_element)},
                      {"elements", json_of(o.elements)}});
    }
  return rows;
}

} // namespace octascope::firmware_host
