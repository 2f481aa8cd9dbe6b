// Which steps a step is made of: it is outdated once one of them is done again and brings something
// new.
#pragma once

#include <span>
#include <string_view>

namespace octascope::firmware_host {

// All of them come before it. Empty: none, or no such step.
std::span<const std::string_view> made_of(std::string_view step);

} // namespace octascope::firmware_host
