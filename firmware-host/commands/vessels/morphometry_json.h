// The table of what a tree measures beside what was published, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/coronary_tree/morphometry_table.h"

namespace octascope::firmware_host {

// A list with an object for each order of each branch that is there.
nlohmann::ordered_json morphometry_json(const sim::MorphometryTable& table);

} // namespace octascope::firmware_host
