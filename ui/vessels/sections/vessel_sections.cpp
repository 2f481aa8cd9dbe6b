#include "ui/vessels/sections/vessel_sections.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ui/panels/projection.h"
#include "ui/vessels/scene/vessel_colour.h"

namespace octascope::ui {

namespace {

constexpr double reach_from_above_mm = 0.4; // as thick as the en-face picture's slab
constexpr float share_steps = 16;
constexpr float longest_piece_mm = 0.2F; // half of what it may fade over

// Axes of the volume's frame.
struct PictureAxes {
  glm::length_t across;
  glm::length_t down;
  glm::length_t off;
};
constexpr PictureAxes axes_of(FlatPicture picture) {
  switch (picture) {
  case FlatPicture::b_scan: return {0, 2, 1};
  case FlatPicture::crossed: return {1, 2, 0};
  case FlatPicture::from_above: break;
  }
  return {0, 1, 2};
}

glm::vec3 extents_of(const pipeline::VolumeGeometry& g) {
  return {static_cast<float>(g.a_mm()), static_cast<float>(g.b_mm()),
          static_cast<float>(g.depth_mm())};
}

// Index of what the picture shows on the axis across it.
int place_of(FlatPicture picture, const ViewState& view) {
  switch (picture) {
  case FlatPicture::b_scan: return view.b_scan;
  case FlatPicture::crossed: return view.a_scan;
  case FlatPicture::from_above: break;
  }
  return 0;
}

float plane_mm(FlatPicture picture, int place, const pipeline::VolumeGeometry& g) {
  const double spacing_um = picture == FlatPicture::b_scan ? g.b_spacing_um : g.a_spacing_um;
  return static_cast<float>((place + 0.5) * spacing_um * 1e-3);
}

VesselColour colour_of(const NearSegment& segment, VesselColouring colouring) {
  return colour_of(colouring, static_cast<std::size_t>(segment.branch), segment.order, drawn_by_gl);
}

bool draws(const ViewState& view) {
  return shows_tree(view) && view.vessel_opacity > 0;
}

// Only what lies nearer to the plane than that is left of it. False if nothing is.
bool cut_to(VesselMark& mark, float nearest_mm) {
  const glm::vec3 along = mark.to_mm - mark.from_mm;
  float begin = 0;
  float end = 1;
  if (std::abs(along.z) > 1e-6F) {
    const float at_lower = (-nearest_mm - mark.from_mm.z) / along.z;
    const float at_upper = (nearest_mm - mark.from_mm.z) / along.z;
    begin = std::max(begin, std::min(at_lower, at_upper));
    end = std::min(end, std::max(at_lower, at_upper));
  } else if (std::abs(mark.from_mm.z) > nearest_mm) {
    return false;
  }
  if (begin > end)
    return false;
  const glm::vec3 from_mm = mark.from_mm;
  const float from_radius_mm = mark.from_radius_mm;
  const float growth_mm = mark.to_radius_mm - mark.from_radius_mm;
  mark.from_mm = from_mm + begin * along;
  mark.to_mm = from_mm + end * along;
  mark.from_radius_mm = from_radius_mm + begin * growth_mm;
  mark.to_radius_mm = from_radius_mm + end * growth_mm;
  return true;
}

} // namespace

double section_reach_mm(const pipeline::VolumeGeometry& geometry) {
  return 2e-3 * std::max(geometry.a_spacing_um, geometry.b_spacing_um);
}

float share_from_above(const glm::vec3& at_mm, const pipeline::VolumeGeometry& geometry,
                       const TissueMap& tissue) {
  const auto index = [](float place_mm, double spacing_um, int count) {
    return std::clamp(
        static_cast<int>(std::floor(place_mm * 1e3F / static_cast<float>(spacing_um))), 0,
        count - 1);
  };
  const TissueMap::Begin begin =
      tissue.begin_of(index(at_mm.y, geometry.b_spacing_um, geometry.b_scans),
                      index(at_mm.x, geometry.a_spacing_um, geometry.a_scans));
  if (begin.depth >= geometry.depths)
    return 0;
  const double depth_voxels = static_cast<double>(at_mm.z) * 1e3 / geometry.depth_spacing_um;
  const double beyond_voxels = std::max(
      {begin.depth - depth_voxels, depth_voxels - SlabFinder{geometry}.slab(begin).end(), 0.0});
  const double share =
      1 - std::min(beyond_voxels * geometry.depth_spacing_um * 1e-3 / reach_from_above_mm, 1.0);
  return std::round(static_cast<float>(share) * share_steps) / share_steps;
}

void VesselSections::show(const PlacedVessels& vessels) {
  vessels_ = vessels;
  ++shown_;
  for (Section& section : sections_) {
    section.near.reserve(vessels.tree.clusters.size());
    section.marks.reserve(NearSegments::most_segments);
  }
  made_.reserve(NearSegments::most_segments);
}

void VesselSections::search(Section& section, FlatPicture picture, const Sight& sight) {
  ++searches_;
  VolumeBox box{glm::vec3{0}, extents_of(sight.geometry)};
  if (picture != FlatPicture::from_above) {
    const glm::length_t off = axes_of(picture).off;
    const float at_mm = plane_mm(picture, section.key->place, sight.geometry);
    const auto reach_mm = static_cast<float>(section_reach_mm(sight.geometry));
    box.lower_mm[off] = at_mm - reach_mm;
    box.upper_mm[off] = at_mm + reach_mm;
  }
  section.near.find(vessels_.tree,
                    volume_from_tree(vessels_, sight.view.vessel_nudge, sight.geometry), box);
}

void VesselSections::mark_cut(FlatPicture picture, const Section& section, const Sight& sight) {
  const auto [across, down, off] = axes_of(picture);
  const float at_mm = plane_mm(picture, section.key->place, sight.geometry);
  const auto reach_mm = static_cast<float>(section_reach_mm(sight.geometry));
  for (const NearSegment& s : section.near.segments()) {
    VesselMark mark{{s.from_mm[across], s.from_mm[down], s.from_mm[off] - at_mm},
                    {s.to_mm[across], s.to_mm[down], s.to_mm[off] - at_mm},
                    s.from_radius_mm,
                    s.to_radius_mm,
                    1,
                    1,
                    colour_of(s, sight.view.vessel_colouring)};
    if (cut_to(mark, reach_mm + s.thickest_mm()))
      made_.push_back(mark);
  }
}

// In pieces that are short beside what they fade over, so that none passes through the slab unseen;
// as far as there is room for more marks than segments.
void VesselSections::mark_from_above(const Section& section, const Sight& sight) {
  const std::span<const NearSegment> segments = section.near.segments();
  std::size_t room = NearSegments::most_segments - segments.size();
  for (const NearSegment& s : segments) {
    const float length_mm = glm::distance(s.from_mm, s.to_mm);
    const std::size_t pieces =
        1 + std::min(static_cast<std::size_t>(length_mm / longest_piece_mm), room);
    room -= pieces - 1;
    VesselMark mark{{},
                    {s.from_mm.x, s.from_mm.y, 0},
                    0,
                    s.from_radius_mm,
                    0,
                    share_from_above(s.from_mm, sight.geometry, sight.tissue),
                    colour_of(s, sight.view.vessel_colouring)};
    for (std::size_t i = 1; i <= pieces; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(pieces);
      const glm::vec3 to_mm = glm::mix(s.from_mm, s.to_mm, t);
      mark.from_mm = mark.to_mm;
      mark.from_radius_mm = mark.to_radius_mm;
      mark.from_share = mark.to_share;
      mark.to_mm = {to_mm.x, to_mm.y, 0};
      mark.to_radius_mm = glm::mix(s.from_radius_mm, s.to_radius_mm, t);
      mark.to_share = share_from_above(to_mm, sight.geometry, sight.tissue);
      if (mark.from_share > 0 || mark.to_share > 0)
        made_.push_back(mark);
    }
  }
}

void VesselSections::update(FlatPicture picture, const Sight& sight) {
  Section& section = of(picture);
  const bool drawn =
      draws(sight.view) && vessels_.volume_from_tree && !vessels_.tree.clusters.empty();
  const Key key{shown_,
                drawn,
                sight.view.vessel_nudge,
                sight.geometry,
                place_of(picture, sight.view),
                sight.view.vessel_colouring};
  const bool from_above = picture == FlatPicture::from_above;
  if (section.key == key && (!from_above || section.volume == sight.volume))
    return;
  const bool searched = section.key != key;
  section.key = key;
  section.volume = sight.volume;
  made_.clear();
  if (drawn) {
    if (searched)
      search(section, picture, sight);
    if (from_above)
      mark_from_above(section, sight);
    else
      mark_cut(picture, section, sight);
  }
  if (made_ == section.marks)
    return;
  std::swap(made_, section.marks);
  ++section.version;
}

} // namespace octascope::ui
