#include "tests/soak/soak_verdict.h"

#include <algorithm>

#include <fmt/format.h>

#include "tests/support/program/report_sums.h"

namespace octascope::tests {

Held held_between(const std::vector<ProcessSample>& samples, double from_s, double until_s) {
  Held held;
  std::vector<double> resident;
  for (const ProcessSample& sample : samples) {
    if (sample.at_s < from_s || sample.at_s >= until_s)
      continue;
    resident.push_back(sample.resident_kib);
    held.descriptors = std::max(held.descriptors, sample.descriptors);
    held.threads = std::max(held.threads, sample.threads);
  }
  held.samples = resident.size();
  if (!resident.empty()) {
    const auto middle = resident.begin() + static_cast<std::ptrdiff_t>(resident.size() / 2);
    std::nth_element(resident.begin(), middle, resident.end());
    held.resident_kib = *middle;
  }
  return held;
}

std::vector<std::string> complaints_about_growth(const Held& settled, const Held& final) {
  std::vector<std::string> all;
  if (settled.samples < 3 || final.samples < 3)
    return {fmt::format("{} and {} samples, expected three at least: was the run cut short?",
                        settled.samples, final.samples)};
  if (final.resident_kib > settled.resident_kib * (1 + most_growth))
    all.push_back(fmt::format("resident memory grew from {:.0f} to {:.0f} KiB, {:+.2f} %, expected "
                              "at most {:+.0f} %",
                              settled.resident_kib, final.resident_kib,
                              100 * (final.resident_kib / settled.resident_kib - 1),
                              100 * most_growth));
  if (final.descriptors > settled.descriptors)
    all.push_back(
        fmt::format("descriptors grew from {} to {}", settled.descriptors, final.descriptors));
  if (final.threads > settled.threads)
    all.push_back(fmt::format("threads grew from {} to {}", settled.threads, final.threads));
  return all;
}

std::vector<std::string> complaints_about_volumes(const nlohmann::json& report, double most_lost) {
  std::vector<std::string> all;
  if (const std::string words = unbalanced(report); !words.empty())
    all.push_back(words.substr(0, words.size() - 1));
  if (const double lost = report.at("lost").at("volumes"); lost > most_lost)
    all.push_back(fmt::format("{:.0f} volumes lost, the faults explain {:.0f}", lost, most_lost));
  if (report.at("volumes").at("displayed") == 0)
    all.emplace_back("no volume was displayed");
  return all;
}

} // namespace octascope::tests
