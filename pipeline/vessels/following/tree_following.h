// Keeps a known tree where the tissue is: registered to the trees that are traced now and then, and
// moved with the volumes in between.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>

#include "pipeline/vessels/following/tree_registration.h"
#include "pipeline/vessels/following/volume_motion.h"

namespace octascope::pipeline {

struct FollowedPlace {
  // Where the tree lies in the volume that was added last; empty while that is not known.
  std::optional<RigidTransform> volume_from_tree;
  double residual_mm = 0; // of the last registration that was accepted
  double overlap = 0;     // likewise
  std::string refusal; // why the last one was not, or why the volumes are not followed; else empty
};

// From one thread at a time.
//
// The first search begins at `start`, or with the tree in the volume's own frame, and looks as far as
// first_reach(). Later ones begin where the tree was last, and look nearby; if nothing is there, again as far.
// A place is given up with the third tree in a row that does not match, as one alone may be badly
// traced, and at once when a volume has nothing in common with the one that the tree was registered in.
// While the place is not known, the next three trees after a search in vain are left alone: it takes half a
// second of a core.
class TreeFollowing {
public:
  static constexpr int most_misses = 3;
  static constexpr int trees_between_searches = 3;

  TreeFollowing(VesselTree tree, const std::optional<RigidTransform>& start);

  // Forgets where it was: it lies about there.
  void begin_at(const RigidTransform& start);

  // In their order, `index` as in VolumeMetadata; of those that are left out nothing is known.
  void add_volume(const VolumeGeometry& geometry, std::span<const std::uint8_t> levels,
                  std::span<const BScanState> states, std::uint64_t index);
  // Traced in the volume of that index, or in one between two that were added. One that is older than all
  // that are remembered is left out: what moved since is not known.
  void add_tree(const VesselTree& live, std::uint64_t volume_index);

  const FollowedPlace& place() const { return place_; }

private:
  struct Seen {
    std::uint64_t index = 0;
    VolumeSpectrum spectrum;
  };

  const Seen& nearest(std::uint64_t index) const; // of some that were seen
  // Of what lay at `registered_` when the reference was seen.
  std::optional<RigidTransform> moved_to(const VolumeSpectrum& volume);
  void accept(const TreeRegistration& found, const Seen& traced_in);
  void miss(const std::string& refusal);
  void lose(std::string refusal);

  VesselTree tree_;
  RigidTransform registered_; // or where to begin
  bool known_ = false;        // it is where the tree lay in the reference
  std::optional<VolumeSpectrum> reference_;
  std::deque<Seen> seen_; // the last few
  std::optional<VolumeGeometry> geometry_;
  std::optional<VolumeMotion> motion_;
  int misses_ = 0;
  int left_alone_ = 0; // trees still to be
  FollowedPlace place_;
};

} // namespace octascope::pipeline
