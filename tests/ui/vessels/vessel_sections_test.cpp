// Which vessels are marked in the flat pictures, where, and how strongly.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_tree.h"
#include "tests/ui/support/synthetic_volume.h"
#include "tests/ui/support/vessels/vessel_along.h"
#include "ui/vessels/sections/near_segments.h"
#include "ui/vessels/sections/vessel_sections.h"

namespace octascope::tests {
namespace {

using ui::FlatPicture;
using ui::VesselMark;

ui::TissueMap map_of(const pipeline::Volume& volume) {
  pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  ui::TissueMap tissue;
  tissue.update(occupancy, volume.b_scan_states);
  return tissue;
}

// Of that level from one depth to before another, all over.
void add_layer(pipeline::Volume& volume, int from, int to, std::uint8_t level) {
  const pipeline::VolumeGeometry& g = volume.geometry;
  for (int b = 0; b < g.b_scans; ++b)
    for (int a = 0; a < g.a_scans; ++a)
      std::fill_n(volume.b_scan(b).begin() + a * g.depths + from, to - from, level);
}

// Noise, and a layer of tissue that begins in the brick at that depth (of 8 voxels).
ui::TissueMap tissue_from(const pipeline::VolumeGeometry& geometry, int depth) {
  pipeline::Volume volume = uniform_volume(geometry, 60);
  add_layer(volume, depth + 4, depth + 32, 150);
  return map_of(volume);
}

// From its wall, negative inside, of a cone with round ends.
float from_wall(const glm::vec3& at, const glm::vec3& from, const glm::vec3& to, float from_radius,
                float to_radius) {
  const glm::vec3 along = to - from;
  const float t =
      glm::clamp(glm::dot(at - from, along) / std::max(glm::dot(along, along), 1e-12F), 0.0F, 1.0F);
  return glm::distance(at, from + t * along) - glm::mix(from_radius, to_radius, t);
}

float from_marks(std::span<const VesselMark> marks, float across_mm, float down_mm) {
  float nearest = 1e9F;
  for (const VesselMark& m : marks)
    nearest = std::min(nearest, from_wall({across_mm, down_mm, 0}, m.from_mm, m.to_mm,
                                          m.from_radius_mm, m.to_radius_mm));
  return nearest;
}

// ---- A phantom's vessels.

class PhantomSections : public testing::TestWithParam<std::string_view> {
protected:
  void SetUp() override {
    made_ = sim::phantom_tree(*phantom_);
    arrays_ = pipeline::build_clusters(made_.tree);
    sections_.show({arrays_.view(), {}, made_.volume_from_tree});
    for (const sim::VesselSegment& s : phantom_->vessels())
      if (in_field(s.from) && in_field(s.to))
        vessels_.push_back({placed(s.from), placed(s.to), s.radius_mm});
  }

  struct Vessel {
    glm::vec3 from_mm;
    glm::vec3 to_mm;
    float radius_mm;
  };

  // From the phantom's own frame; its origin is in the middle of the field and of the first bin.
  glm::vec3 placed(const sim::VesselPoint& p) const {
    return glm::vec3{p.x_mm, p.y_mm, p.depth_mm} +
           glm::vec3{static_cast<float>(geometry_.a_mm() / 2),
                     static_cast<float>(geometry_.b_mm() / 2),
                     static_cast<float>(geometry_.depth_spacing_um / 2000)};
  }
  bool in_field(const sim::VesselPoint& p) const {
    const glm::vec3 at = placed(p);
    return at.x > 0 && at.y > 0 && at.z > 0 && at.x < static_cast<float>(geometry_.a_mm()) &&
           at.y < static_cast<float>(geometry_.b_mm()) &&
           at.z < static_cast<float>(geometry_.depth_mm());
  }

  // Radii from which on vessels are drawn: of more than most_segments in the volume, the thinnest are
  // not. Half more than the thinnest that is, as a branch starts as thick as what it leaves.
  float thinnest_drawn_mm() const {
    std::vector<float> radii;
    for (const Vessel& v : vessels_)
      radii.push_back(v.radius_mm);
    std::ranges::sort(radii, std::greater{});
    return radii.size() > ui::NearSegments::most_segments
               ? 1.5F * radii[ui::NearSegments::most_segments]
               : 0;
  }

  std::span<const VesselMark> marks(FlatPicture picture, int place) {
    view_.b_scan = view_.a_scan = place;
    sections_.update(picture, {view_, geometry_, tissue_, 1});
    return sections_.marks(picture);
  }

  // Where axes of the phantom's vessels go through the plane of a B-scan.
  std::vector<glm::vec3> crossings(int axis, float plane_mm) const {
    std::vector<glm::vec3> at;
    for (const Vessel& v : vessels_)
      if ((v.from_mm[axis] - plane_mm) * (v.to_mm[axis] - plane_mm) < 0)
        at.push_back(glm::mix(v.from_mm, v.to_mm,
                              (plane_mm - v.from_mm[axis]) / (v.to_mm[axis] - v.from_mm[axis])));
    return at;
  }

  // Around each crossing, whatever is inside a vessel of the phantom is inside a mark, and the
  // other way round, but for a voxel at the walls.
  void expect_sections(FlatPicture picture, int axis, int place, double spacing_um) {
    const auto plane_mm = static_cast<float>((place + 0.5) * spacing_um * 1e-3);
    const auto found = marks(picture, place);
    const auto voxel_mm = static_cast<float>(
        1e-3 * std::max(geometry_.depth_spacing_um,
                        axis == 1 ? geometry_.a_spacing_um : geometry_.b_spacing_um));
    const auto deep_voxel_mm = static_cast<float>(1e-3 * geometry_.depth_spacing_um);
    const int across = axis == 1 ? 0 : 1;
    for (const glm::vec3& at : crossings(axis, plane_mm)) {
      ++crossed_;
      EXPECT_LT(from_marks(found, at[across], at.z), 0) << "its axis is in it";
      for (int i = 0; i < 24; ++i) {
        glm::vec3 near = at;
        near[across] += 0.2F * voxel_mm * static_cast<float>(i % 6 - 3) * 5;
        near.z += 4 * deep_voxel_mm * static_cast<float>(i / 6 - 2);
        float reference = 1e9F;
        for (const Vessel& v : vessels_)
          reference =
              std::min(reference, from_wall(near, v.from_mm, v.to_mm, v.radius_mm, v.radius_mm));
        const float distance = from_marks(found, near[across], near.z);
        if (std::abs(reference) > voxel_mm) {
          ++judged_;
          EXPECT_EQ(distance < 0, reference < 0)
              << "at " << near.x << ", " << near.y << ", " << near.z;
        }
      }
    }
  }

  std::unique_ptr<sim::Phantom> phantom_ = *sim::make_phantom(GetParam(), 1);
  pipeline::VolumeGeometry geometry_ = phantom_->suggested_plan().geometry();
  sim::PhantomTree made_;
  pipeline::ClusterArrays arrays_;
  std::vector<Vessel> vessels_;
  ui::VesselSections sections_;
  ui::TissueMap tissue_ = tissue_from(geometry_, 16);
  ui::ViewState view_;
  int crossed_ = 0;
  int judged_ = 0;
};

TEST_P(PhantomSections, lie_in_both_b_scans_where_the_phantom_has_its_vessels) {
  for (int b = 2; b < geometry_.b_scans; b += 7)
    expect_sections(FlatPicture::b_scan, 1, b, geometry_.b_spacing_um);
  for (int a = 5; a < geometry_.a_scans; a += 23)
    expect_sections(FlatPicture::crossed, 0, a, geometry_.a_spacing_um);
  EXPECT_GT(crossed_, 20);
  EXPECT_GT(judged_, 200);
}

TEST_P(PhantomSections, lie_from_above_where_the_phantom_has_its_vessels) {
  pipeline::Volume whole = uniform_volume(geometry_, 60);
  add_layer(whole, 16, 24, 150); // a front layer, and a gap, so that all behind it is shown
  const int behind = 40 + static_cast<int>(400 / geometry_.depth_spacing_um);
  add_layer(whole, behind, behind + 24, 150);
  tissue_ = map_of(whole);
  const auto found = marks(FlatPicture::from_above, 0);
  ASSERT_FALSE(found.empty());
  const auto voxel_mm =
      static_cast<float>(1e-3 * std::max(geometry_.a_spacing_um, geometry_.b_spacing_um));
  int judged = 0;
  const float thinnest_mm = thinnest_drawn_mm();
  for (const Vessel& v : vessels_) {
    const glm::vec3 middle = 0.5F * (v.from_mm + v.to_mm);
    if (middle.z * 1e3F < static_cast<float>(behind * geometry_.depth_spacing_um) ||
        v.radius_mm < thinnest_mm)
      continue;
    ++judged;
    EXPECT_LT(from_marks(found, middle.x, middle.y), 0);
  }
  for (const VesselMark& m : found) {
    const glm::vec3 middle = 0.5F * (m.from_mm + m.to_mm);
    float nearest = 1e9F;
    for (const Vessel& v : vessels_)
      nearest = std::min(nearest, from_wall({middle.x, middle.y, 0}, {v.from_mm.x, v.from_mm.y, 0},
                                            {v.to_mm.x, v.to_mm.y, 0}, 0, 0));
    EXPECT_LT(nearest, voxel_mm);
  }
  EXPECT_GT(judged, 20);
}

INSTANTIATE_TEST_SUITE_P(Phantom, PhantomSections, testing::ValuesIn(sim::phantom_names),
                         [](const auto& test) { return std::string{test.param}; });

// ---- What is marked.

class VesselSectionsTest : public testing::Test {
protected:
  void show(const pipeline::ClusterArrays& tree) {
    sections_.show({tree.view(), {}, pipeline::RigidTransform{}});
  }
  std::span<const VesselMark> marks(FlatPicture picture) {
    sections_.update(picture, {view_, geometry_, tissue_, volume_});
    return sections_.marks(picture);
  }

  const pipeline::VolumeGeometry geometry_ = small_geometry; // 3 × 3 × 1.79 mm
  ui::VesselSections sections_;
  ui::TissueMap tissue_ = tissue_from(geometry_, 32); // 0.45 mm deep
  ui::ViewState view_;
  std::uint64_t volume_ = 1;
};

TEST_F(VesselSectionsTest, move_with_the_position) {
  const auto tree = vessel_along({{0.5F, 0.2F, 0.9F}, {2.5F, 2.8F, 1.3F}}, 0.05F); // at a slant
  show(tree);
  for (const int b : {10, 20, 30}) {
    view_.b_scan = b;
    const float y_mm = 0.075F * (static_cast<float>(b) + 0.5F);
    const float t = (y_mm - 0.2F) / 2.6F;
    const auto found = marks(FlatPicture::b_scan);
    ASSERT_EQ(found.size(), 1U);
    const glm::vec3 along = found[0].to_mm - found[0].from_mm;
    const glm::vec3 at = found[0].from_mm - found[0].from_mm.z / along.z * along;
    EXPECT_NEAR(at.x, 0.5F + 2 * t, 1e-3F);
    EXPECT_NEAR(at.y, 0.9F + 0.4F * t, 1e-3F);
    // What is too far from the plane is cut off.
    const auto reach_mm = static_cast<float>(ui::section_reach_mm(geometry_));
    EXPECT_NEAR(std::abs(found[0].from_mm.z), reach_mm + 0.05F, 1e-3F);
    EXPECT_NEAR(std::abs(found[0].to_mm.z), reach_mm + 0.05F, 1e-3F);
  }
}

TEST_F(VesselSectionsTest, follow_a_nudge) {
  const auto tree = vessel_along({{0.5F, 1.5F, 0.9F}, {2.5F, 1.5F, 0.9F}}, 0.05F);
  show(tree);
  view_.b_scan = 20;
  const VesselMark before = marks(FlatPicture::b_scan)[0];
  view_.vessel_nudge.shift_mm = {0.2F, 0.05F, -0.1F};
  const VesselMark after = marks(FlatPicture::b_scan)[0];
  EXPECT_NEAR(after.from_mm.x - before.from_mm.x, 0.2F, 1e-4F);
  EXPECT_NEAR(after.from_mm.y - before.from_mm.y, -0.1F, 1e-4F);
  EXPECT_NEAR(after.from_mm.z - before.from_mm.z, 0.05F, 1e-4F);
}

TEST_F(VesselSectionsTest, are_none_without_a_registration_or_far_away_or_hidden) {
  const auto tree = vessel_along({{0.5F, 1.5F, 0.9F}, {2.5F, 1.5F, 0.9F}}, 0.05F);
  constexpr std::array pictures{FlatPicture::b_scan, FlatPicture::crossed, FlatPicture::from_above};
  view_.b_scan = 20;
  view_.a_scan = 50;
  const auto count = [&] { // of the pictures that have marks
    int all = 0;
    for (const FlatPicture picture : pictures)
      all += marks(picture).empty() ? 0 : 1;
    return all;
  };
  show(tree);
  EXPECT_EQ(count(), 3);
  sections_.show({tree.view(), {1.5, 1.5, 0.9}, std::nullopt});
  EXPECT_EQ(count(), 0) << "not registered";
  pipeline::RigidTransform elsewhere;
  elsewhere.shift_mm = {100, 0, 0};
  sections_.show({tree.view(), {}, elsewhere});
  EXPECT_EQ(count(), 0) << "registered to another place";
  show(tree);
  view_.vessels = ui::VesselsShown::off;
  EXPECT_EQ(count(), 0) << "hidden";
  view_.vessels = ui::VesselsShown::both;
  view_.vessel_opacity = 0;
  EXPECT_EQ(count(), 0) << "without opacity";
  view_.vessel_opacity = 1;
  EXPECT_EQ(count(), 3) << "again";
  sections_.show({});
  EXPECT_EQ(count(), 0) << "no tree";
}

TEST_F(VesselSectionsTest, have_the_colours_of_the_view) {
  const auto tree = vessel_along({{0.5F, 1.5F, 0.9F}, {2.5F, 1.5F, 0.9F}}, 0.05F);
  show(tree);
  view_.b_scan = 20;
  EXPECT_EQ(marks(FlatPicture::b_scan)[0].colour, ui::branch_colours[0]);
  view_.vessel_colouring = ui::VesselColouring::order;
  EXPECT_EQ(marks(FlatPicture::b_scan)[0].colour, ui::order_colours[8]);
}

// ---- Fading from above.

TEST_F(VesselSectionsTest, are_full_in_the_slab_and_fade_above_and_below_it) {
  const auto share = [&](float z_mm) {
    return ui::share_from_above({1.5F, 1.5F, z_mm}, geometry_, tissue_);
  };
  // The surface at 0.448 mm; the slab begins 16 voxels of 14 µm below it and is 32 voxels thick.
  const float begin_mm = 32 * 0.014F;
  const float end_mm = (32 + 16 + 32) * 0.014F;
  EXPECT_EQ(share(begin_mm), 1);
  EXPECT_EQ(share(begin_mm + 0.1F), 1) << "between the surface and the slab";
  EXPECT_EQ(share(end_mm), 1);
  for (const float gap_mm : {0.1F, 0.2F, 0.3F}) {
    EXPECT_NEAR(share(begin_mm - gap_mm), 1 - gap_mm / 0.4F, 1.0F / 32 + 1e-3F);
    EXPECT_NEAR(share(end_mm + gap_mm), 1 - gap_mm / 0.4F, 1.0F / 32 + 1e-3F);
  }
  EXPECT_EQ(share(begin_mm - 0.41F), 0);
  EXPECT_EQ(share(end_mm + 0.41F), 0);
  tissue_ = map_of(uniform_volume(geometry_, 60));
  EXPECT_EQ(share(begin_mm + 0.1F), 0) << "no tissue is seen there";
}

TEST_F(VesselSectionsTest, one_that_passes_through_the_slab_is_full_there) {
  const auto tree = vessel_along({{1, 1.5F, 0.01F}, {2, 1.5F, 1.78F}}, 0.05F); // a single segment
  show(tree);
  const auto found = marks(FlatPicture::from_above);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(std::ranges::max(found, {}, &VesselMark::from_share).from_share, 1);
  const float most =
      std::ranges::max(found, {}, [](const VesselMark& mark) { return mark.to_mm.x; }).to_mm.x;
  EXPECT_LT(most, 1.95F) << "its deep end is far from the slab";
}

TEST_F(VesselSectionsTest, follow_the_tissue_of_each_volume_without_another_search) {
  const auto tree = vessel_along({{0.5F, 1.5F, 0.6F}, {2.5F, 1.5F, 0.6F}}, 0.05F);
  show(tree);
  EXPECT_EQ(marks(FlatPicture::from_above)[0].from_share, 1);
  const std::uint64_t searches = sections_.searches();
  const std::uint64_t version = sections_.version(FlatPicture::from_above);
  ++volume_;
  marks(FlatPicture::from_above);
  EXPECT_EQ(sections_.version(FlatPicture::from_above), version) << "the same tissue";
  tissue_ = tissue_from(geometry_, 64); // 0.9 mm deep
  ++volume_;
  EXPECT_LT(marks(FlatPicture::from_above)[0].from_share, 0.5F);
  EXPECT_EQ(sections_.searches(), searches);
  EXPECT_GT(sections_.version(FlatPicture::from_above), version);
}

TEST_F(VesselSectionsTest, are_searched_for_only_when_something_has_changed) {
  const auto tree = vessel_along({{0.5F, 1.5F, 0.9F}, {2.5F, 1.5F, 0.9F}}, 0.05F);
  show(tree);
  marks(FlatPicture::b_scan);
  marks(FlatPicture::crossed);
  const std::uint64_t searches = sections_.searches();
  ++volume_;
  view_.yaw_deg += 10;
  view_.window_offset_db += 1;
  marks(FlatPicture::b_scan);
  marks(FlatPicture::crossed);
  EXPECT_EQ(sections_.searches(), searches);
  view_.b_scan += 1;
  marks(FlatPicture::b_scan);
  marks(FlatPicture::crossed);
  EXPECT_EQ(sections_.searches(), searches + 1) << "the one that moved";
}

} // namespace
} // namespace octascope::tests
