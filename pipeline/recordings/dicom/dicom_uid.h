// Unique identifiers (UIDs) for DICOM, derived from what they name.
#pragma once

#include <string>
#include <string_view>

namespace octascope::pipeline {

// "2.25." and the decimal digits of a UUID (PS3.5, B.2), which nobody has to assign. The UUID is
// one that is made of a hash (RFC 9562, version 8): the same for the same `name`, always, and
// another for any other name, with a chance of 1 in 2^122 that two are the same.
std::string derive_uid(std::string_view name);

} // namespace octascope::pipeline
