// The report of a commissioning: one HTML file with its pictures in it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "firmware-host/commands/commission/session.h"

namespace octascope::firmware_host {

struct ReportedStep {
  std::string_view key;
  std::string_view title;
};

// As it stands now; pictures that cannot be read are left out, and it says so. Nothing in it is
// fetched from elsewhere; it prints on A4 or letter.
std::string commission_report(const Session& session, std::span<const ReportedStep> steps);

std::string base64(std::string_view bytes);

} // namespace octascope::firmware_host
