// A tree of vessels: nodes with radii, joined to their parents by segments.
//
// Every node but a root makes one segment, from its parent to itself, and is named by the same
// index. Orders are diameter-defined Strahler orders (Kassab, Rider, Tang, Fung, Am J Physiol 265,
// 1993): 0 for capillary arterioles, 11 for the mouth of a main artery.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octascope::pipeline {

// The main branch that a segment belongs to. Kept as SWC types 16 to 18 (SWC leaves types from 5 on
// to the user); unknown is 0.
enum class VesselBranch : std::uint8_t { unknown, rca, lad, lcx };
inline constexpr int vessel_branch_count = 4;

inline constexpr int highest_vessel_order = 11;
inline constexpr int vessel_order_count = highest_vessel_order + 1;

inline constexpr std::uint32_t no_parent = 0xFFFFFFFF;

// One array a property, all of the same length. Parents come before their children. Lengths in
// millimetres, in the tree's own frame.
struct VesselTree {
  std::vector<std::array<float, 3>> positions_mm;
  std::vector<float> radii_mm;
  std::vector<std::uint32_t> parents; // no_parent for roots
  std::vector<std::uint8_t> orders;   // of the segment that ends here
  std::vector<VesselBranch> branches;

  std::size_t nodes() const { return positions_mm.size(); }
};

// A segment is a cone with round ends from its parent's place to its own. It starts with its
// parent's radius where the vessel goes on, and not much wider than itself where it leaves the side
// of a larger one: else each twig of a trunk would be a thorn.
inline constexpr float widest_start = 1.5F; // times the radius at the end
inline float segment_start_radius(float parent_radius, float radius) {
  return std::min(parent_radius, widest_start * radius);
}

} // namespace octascope::pipeline
