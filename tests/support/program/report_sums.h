// The sums that a report's volumes must make (firmware-host/report/report.h).
#pragma once

#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace octascope::tests {

// What does not add up, in words; empty where everything does.
inline std::string unbalanced(const nlohmann::json& report) {
  const auto& volumes = report.at("volumes");
  const auto count = [&](const char* key) { return volumes.at(key).get<std::uint64_t>(); };
  const auto lost = report.at("lost").at("volumes").get<std::uint64_t>();
  std::string words;
  if (count("planned") != count("acquired") + count("passed_over") + lost + count("unfinished"))
    words += fmt::format(
        "{} volumes planned, but {} acquired + {} passed over + {} lost + {} unfinished\n",
        count("planned"), count("acquired"), count("passed_over"), lost, count("unfinished"));
  if (count("acquired") != count("published"))
    words += fmt::format("{} volumes acquired, but {} published\n", count("acquired"),
                         count("published"));
  if (count("acquired") != count("displayed") + count("skipped") + count("lost"))
    words += fmt::format("{} volumes acquired, but {} displayed + {} skipped + {} lost\n",
                         count("acquired"), count("displayed"), count("skipped"), count("lost"));
  return words;
}

} // namespace octascope::tests
