#include "pipeline/volume/volume_geometry.h"

#include <array>
#include <utility>

namespace octascope::pipeline {

namespace {

constexpr std::array<std::pair<bool AssumedSpacings::*, std::string_view>, 3> names{
    {{&AssumedSpacings::depth, "depth"},
     {&AssumedSpacings::a_scans, "A-scan"},
     {&AssumedSpacings::b_scans, "B-scan"}}};

} // namespace

std::string AssumedSpacings::words() const {
  std::string all;
  for (const auto& [assumed, name] : names)
    if (this->*assumed)
      all.append(all.empty() ? "" : ", ").append(name);
  return all;
}

AssumedSpacings AssumedSpacings::parse(std::string_view words) {
  AssumedSpacings spacings;
  for (const auto& [assumed, name] : names)
    spacings.*assumed = words.find(name) != std::string_view::npos;
  return spacings;
}

} // namespace octascope::pipeline
