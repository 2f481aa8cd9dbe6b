// A trace of `run --trace`, as its viewers open it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace octascope::tests {

struct TraceSpan {
  double begin, end; // µs
};

// Its events, by row and in the order of their times.
using TraceRows = std::map<std::string, std::multimap<double, nlohmann::json>>;

inline TraceRows read_trace(const std::filesystem::path& file) {
  std::ifstream stream{file};
  const auto trace = nlohmann::json::parse(stream);
  std::map<int, std::string> names;
  TraceRows rows;
  for (const auto& event : trace.at("traceEvents"))
    if (event.at("ph") == "M" && event.at("name") == "thread_name")
      names[event.at("tid")] = event.at("args").at("name");
  for (const auto& event : trace.at("traceEvents"))
    if (event.at("ph") == "X")
      rows[names.at(event.at("tid"))].emplace(event.at("ts"), event);
  return rows;
}

inline TraceSpan span_of(const nlohmann::json& event) {
  const double begin = event.at("ts");
  return {begin, begin + event.at("dur").get<double>()};
}

// Of one volume, by name; B-scans as "B-scan", from the first's begin to the last's end.
inline std::map<std::string, TraceSpan> passage(const TraceRows& rows, std::uint64_t volume) {
  std::map<std::string, TraceSpan> spans;
  for (const auto& [row, events] : rows)
    for (const auto& [begin, event] : events) {
      if (event.at("args").at("volume") != volume)
        continue;
      const std::string name = row.starts_with("worker") ? "B-scan" : event.at("name");
      const auto [place, is_new] = spans.emplace(name, span_of(event));
      if (!is_new) {
        place->second.begin = std::min(place->second.begin, span_of(event).begin);
        place->second.end = std::max(place->second.end, span_of(event).end);
      }
    }
  return spans;
}

// Where a volume's stages do not follow each other from its last line to the glass; empty if they do.
// Times are written with three digits after the microsecond's point.
inline std::string gap_in(const std::map<std::string, TraceSpan>& spans) {
  constexpr double digit = 0.002;
  for (const auto& [before, after] :
       {std::pair{"exposure", "fetch"}, std::pair{"fetch", "queue"}, std::pair{"assemble", "wait"},
        std::pair{"wait", "upload"}, std::pair{"upload", "draw"}, std::pair{"draw", "flip"}}) {
    const double apart = spans.at(after).begin - spans.at(before).end;
    if (std::abs(apart) > digit)
      return fmt::format("{} begins {} us after {}", after, apart, before);
  }
  for (const auto& [before, after] :
       {std::pair{"queue", "B-scan"}, std::pair{"B-scan", "assemble"}})
    if (spans.at(after).end < spans.at(before).end)
      return fmt::format("{} ends before {}", after, before);
  return {};
}

} // namespace octascope::tests
