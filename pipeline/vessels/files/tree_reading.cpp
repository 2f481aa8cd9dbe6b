#include "pipeline/vessels/files/tree_reading.h"

#include <algorithm>
#include <limits>

namespace octascope::pipeline {

tl::unexpected<hal::Error> reading_stopped(const std::filesystem::path& name) {
  return hal::fail(hal::ErrorCode::disconnected, "{}: reading was broken off", name.string());
}

hal::Result<std::uint64_t> mend_zero_radii(VesselTree& tree, ZeroRadius policy,
                                           const std::filesystem::path& name) {
  const auto zeros = static_cast<std::uint64_t>(std::ranges::count(tree.radii_mm, 0.0F));
  if (zeros == 0)
    return zeros;
  if (policy == ZeroRadius::refuse)
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: found {} nodes of radius 0, expected none (--zero-radius parent gives "
                     "them their parents')",
                     name.string(), zeros);
  constexpr float none = std::numeric_limits<float>::infinity();
  float smallest = none;
  for (const float radius : tree.radii_mm) {
    if (radius > 0)
      smallest = std::min(smallest, radius);
  }
  if (smallest == none)
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: found no radius but 0 in {} nodes, expected radii of more than 0",
                     name.string(), zeros);
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    if (tree.radii_mm[i] == 0)
      tree.radii_mm[i] = tree.parents[i] == no_parent ? smallest : tree.radii_mm[tree.parents[i]];
  }
  return zeros;
}

std::uint64_t count_coincident(const VesselTree& tree) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const std::uint32_t parent = tree.parents[i];
    if (parent != no_parent && tree.positions_mm[i] == tree.positions_mm[parent])
      ++count;
  }
  return count;
}

} // namespace octascope::pipeline
