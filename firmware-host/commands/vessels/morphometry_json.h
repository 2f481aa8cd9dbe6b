// A tree's measurements beside the published ones, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/coronary_tree/morphometry_table.h"

namespace octascope::firmware_host {

// A list with one object for each order of each branch present.
nlohmann::ordered_json morphometry_json(const sim::MorphometryTable& table);

} // namespace octascope::firmware_host
