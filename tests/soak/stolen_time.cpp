#include "tests/soak/stolen_time.h"

#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

namespace octascope::tests {

std::optional<double> stolen_ticks(std::string_view stat) {
  constexpr int columns_until_steal = 8; // user nice system idle iowait irq softirq steal
  std::istringstream line{std::string{stat.substr(0, stat.find('\n'))}};
  std::string name;
  double ticks = 0;
  line >> name;
  for (int column = 0; column < columns_until_steal; ++column)
    line >> ticks;
  if (name != "cpu" || !line)
    return std::nullopt;
  return ticks;
}

double stolen_seconds() {
  std::ifstream file{"/proc/stat"};
  std::string first;
  std::getline(file, first);
  return stolen_ticks(first).value_or(0) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

} // namespace octascope::tests
