// Orders for a tree that brings none: diameter-defined Strahler orders.
//
// Source: Kassab, Rider, Tang, Fung, Am J Physiol 265 (Heart Circ Physiol 34): H350–H365, 1993.
// Vessels (the stretches between two branchings) begin with their Strahler orders: 0 at the tips,
// and where two of the same highest order meet, one more. Then, with mean D and standard deviation
// S of the diameters of each order, the border between orders n and n+1 is put at
// ((D_n + S_n) + (D_n+1 − S_n+1)) / 2, every vessel gets the order of its diameter, and this is
// repeated until no D and S change by more than 1 % of D.
//
// Files hold any radii, so that beyond the paper's procedure:
// - a vessel's diameter is the mean of its nodes';
// - Strahler orders beyond 11 are counted from the top: what is more than 11 below it is order 0;
// - where diameters do not grow from one order to the next, the two become one;
// - a border stays between the two means, and orders without vessels are left out, so that those
//   that are there count from 0 without a gap;
// - where no two diameters differ, or they say the opposite of the tree, Strahler's orders stay.
// The lowest order of the tree is 0, whatever its tips' diameter: a tree that ends at arteries has
// lower orders than the same tree with its capillaries.
#pragma once

#include <cstdint>
#include <stop_token>

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

enum class OrderRule : std::uint8_t { diameter, strahler };

// Fills tree.orders; a root has the highest order of its children. Parents come before children.
// Once `stop` is requested it leaves soon, with orders that mean nothing.
OrderRule assign_vessel_orders(VesselTree& tree, const std::stop_token& stop = {});

} // namespace octascope::pipeline
