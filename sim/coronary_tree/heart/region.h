// A piece of muscle as a set of evenly spread places, and its division between the vessels that
// feed it.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "sim/coronary_tree/heart/vector3.h"

namespace octascope::sim {

using Region = std::span<Vector3>;

Vector3 centre_of(std::span<const Vector3> places); // of no places: the origin

// Unit vector along which the places extend most; perpendicular to `flat` unless that is zero.
Vector3 longest_axis(std::span<const Vector3> places, Vector3 centre, Vector3 flat);

// Reorders the places so that the `count` with the lowest keys come first. Not std::nth_element,
// since the standard leaves the order of the rest open, and with it the bits of every later sum.
template <class Key> void lowest_first(Region places, std::size_t count, const Key& key) {
  std::size_t begin = 0;
  std::size_t end = places.size();
  while (count > begin && count < end && end - begin > 1) {
    const double pivot = key(places[begin + (end - begin) / 2]);
    std::size_t lower = begin; // before it: below the pivot; up to `equal`: the pivot's
    std::size_t equal = begin;
    std::size_t upper = end; // from it on: above the pivot
    while (equal < upper) {
      const double k = key(places[equal]);
      if (k < pivot)
        std::swap(places[lower++], places[equal++]);
      else if (pivot < k)
        std::swap(places[--upper], places[equal]);
      else
        ++equal;
    }
    if (count < lower)
      end = lower;
    else if (count > upper)
      begin = upper;
    else
      return;
  }
}

// Cuts a region across its longest axis and puts `count` places for a side branch first; the vessel
// keeps the places further along its direction.
void divide(Region region, std::size_t count, Vector3 direction, Vector3 flat);

} // namespace octascope::sim
