// What the host of a virtual machine kept from it: who reads a soak's losses must know whether the
// machine had its processors.
#pragma once

#include <optional>
#include <string_view>

namespace octascope::tests {

// Ticks, of all processors together, that something here was ready to run and the host ran others.
// `stat`: the text of /proc/stat (proc_stat(5)). Empty when it does not say.
std::optional<double> stolen_ticks(std::string_view stat);

// Seconds since the machine's start; 0 where there is no host, or the kernel does not say.
double stolen_seconds();

} // namespace octascope::tests
