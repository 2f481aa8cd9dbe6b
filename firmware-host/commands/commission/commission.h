// octascope commission: from a box of parts to a calibrated picture, step by step.
#pragma once

#include <filesystem>
#include <istream>

#include <CLI/App.hpp>

#include "hal/result.h"

namespace octascope::firmware_host {

struct CommissionOptions {
  std::filesystem::path folder; // of all that is found; made where missing, gone on with where not
  bool simulate = false;        // on the twins, whatever is plugged in
};

// Asks on standard output and takes the answers, a line each, from `answers`. What a step found is
// kept in the folder as soon as it is done. ErrorCode::disconnected: the answers ended before the
// last step, which an answer may also ask for; the same folder goes on from there.
hal::Result<> commission(const CommissionOptions& options, std::istream& answers);

// As add_reconstruct_command().
void add_commission_command(CLI::App& app, int& exit_status);

} // namespace octascope::firmware_host
