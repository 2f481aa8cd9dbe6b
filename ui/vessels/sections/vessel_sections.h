// What is seen of a vessel tree in the flat pictures: in the two crossed B-scans what they cut and
// what runs near them, and from above all of it, along the depth. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/volume/volume_geometry.h"
#include "ui/panels/tissue_map.h"
#include "ui/vessels/sections/near_segments.h"
#include "ui/view/vessel_look.h"
#include "ui/view/vessel_placement.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

enum class FlatPicture : std::uint8_t {
  b_scan,     // across: the fast axis, down: the depth
  crossed,    // across: the slow axis, down: the depth
  from_above, // across: the fast axis, down: the slow one; en face and microscope
};

// A segment in a flat picture: a cone with round ends, in mm from the corner of the volume's first
// voxel: across the picture, down it, and off its plane (0 from above).
struct VesselMark {
  glm::vec3 from_mm;
  glm::vec3 to_mm;
  float from_radius_mm;
  float to_radius_mm;
  float from_share; // of full strength, at each end: fading with depth from above, else 1
  float to_share;
  VesselColour colour;

  bool operator==(const VesselMark&) const = default;
};

// The distance from a vessel's wall to the plane of a B-scan over which it fades to nothing: two
// steps of the coarser axis.
double section_reach_mm(const pipeline::VolumeGeometry& geometry);

// Strength seen from above, 0 to 1: full from the surface, or from the end of the gap behind a
// front layer, down to the end of the en-face picture's slab, and none 0.4 mm above and below that,
// nor where no tissue was found. In sixteenths, so that noise changes little. `at_mm` is in the
// volume's frame.
float share_from_above(const glm::vec3& at_mm, const pipeline::VolumeGeometry& geometry,
                       const TissueMap& tissue);

// A tree without a registration, or one that the view hides, makes no marks.
//
// Threads: one at a time. Allocates in show() alone. The work is bounded as NearSegments says, and
// done only when the plane, the tree's place or its colours change; from above, the strengths are
// computed anew for each volume.
class VesselSections {
public:
  // The tree is borrowed until the next show().
  void show(const PlacedVessels& vessels);

  struct Sight {
    const ViewState& view;
    const pipeline::VolumeGeometry& geometry;
    const TissueMap& tissue;
    std::uint64_t volume; // a counter of the volumes shown
  };
  void update(FlatPicture picture, const Sight& sight);

  // Of the last update() of that picture.
  std::span<const VesselMark> marks(FlatPicture picture) const { return of(picture).marks; }
  // Counts the changes of the marks.
  std::uint64_t version(FlatPicture picture) const { return of(picture).version; }
  // Whether no thin vessel was left out.
  bool complete(FlatPicture picture) const {
    return of(picture).marks.empty() || of(picture).near.complete();
  }
  // The searches in the tree so far, in all pictures.
  std::uint64_t searches() const { return searches_; }

private:
  // What the segments near a picture depend on.
  struct Key {
    std::uint64_t tree;
    bool drawn;
    VesselNudge nudge;
    pipeline::VolumeGeometry geometry;
    int place;
    VesselColouring colouring;
    bool operator==(const Key&) const = default;
  };
  struct Section {
    NearSegments near;
    std::optional<Key> key{};
    std::uint64_t volume = 0;
    std::vector<VesselMark> marks{};
    std::uint64_t version = 0;
  };

  Section& of(FlatPicture picture) { return sections_[static_cast<std::size_t>(picture)]; }
  const Section& of(FlatPicture picture) const {
    return sections_[static_cast<std::size_t>(picture)];
  }
  void search(Section& section, FlatPicture picture, const Sight& sight);
  void mark_cut(FlatPicture picture, const Section& section, const Sight& sight);
  void mark_from_above(const Section& section, const Sight& sight);

  PlacedVessels vessels_;
  std::uint64_t shown_ = 0;
  std::uint64_t searches_ = 0;
  std::array<Section, 3> sections_;
  std::vector<VesselMark> made_; // to be compared with those that there are
};

} // namespace octascope::ui
