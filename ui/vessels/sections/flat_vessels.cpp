#include "ui/vessels/sections/flat_vessels.h"

#include <algorithm>
#include <utility>

namespace octascope::ui {

namespace {

constexpr float line_width = 1.3F; // at unit 1: as the lines of the positions
// A B-scan cuts few vessels; from above all of them lie over the tissue.
constexpr float cut_line_opacity = 0.9F;
constexpr float line_opacity_from_above = 0.55F;

FlatPicture picture_of(VesselPanel panel) {
  switch (panel) {
  case VesselPanel::b_scan: return FlatPicture::b_scan;
  case VesselPanel::crossed: return FlatPicture::crossed;
  case VesselPanel::en_face:
  case VesselPanel::microscope: break;
  }
  return FlatPicture::from_above;
}

SectionPainter::Style style_of(FlatPicture picture, const VesselSections::Sight& sight,
                               const PicturePlace& place, float unit) {
  SectionPainter::Style style{std::max(1.0F, line_width * unit), line_opacity_from_above, 0,
                              sight.view.vessel_opacity};
  if (picture != FlatPicture::from_above) {
    style.line_opacity = cut_line_opacity;
    style.reach_px = static_cast<float>(section_reach_mm(sight.geometry)) * place.pixels_per_mm();
  }
  return style;
}

} // namespace

hal::Result<FlatVessels> FlatVessels::create() {
  HAL_TRY(auto painter, SectionPainter::create());
  return FlatVessels{std::move(painter)};
}

FlatVessels::FlatVessels(SectionPainter painter) : painter_{std::move(painter)} {
  placed_.reserve(NearSegments::most_segments);
}

void FlatVessels::show(const PlacedVessels& vessels) {
  sections_.show(vessels);
}

hal::Result<> FlatVessels::prepare(VesselPanel panel, const VesselSections::Sight& sight,
                                   const PicturePlace& place, float unit) {
  const FlatPicture picture = picture_of(panel);
  sections_.update(picture, sight);
  KeptPicture& kept = pictures_[static_cast<std::size_t>(panel)];
  const SectionPainter::Style style = style_of(picture, sight, place, unit);
  const Key key{sections_.version(picture), place, style};
  if (kept.key == key)
    return {};
  kept.key.reset();
  ++kept.version;
  kept.covered = place_marks(sections_.marks(picture), place, style.line_px, placed_);
  if (!kept.covered.empty()) {
    HAL_CHECK(painter_.draw(kept.layer, placed_, style, place.width, place.height));
    ++drawings_;
  }
  kept.key = key;
  return {};
}

std::uint64_t FlatVessels::version(VesselPanel panel) const {
  return pictures_[static_cast<std::size_t>(panel)].version;
}

void FlatVessels::draw(VesselPanel panel, const Rect& rect, int target_height) const {
  const KeptPicture& kept = pictures_[static_cast<std::size_t>(panel)];
  if (!kept.covered.empty())
    painter_.blend(kept.layer, kept.covered, rect, target_height);
}

bool FlatVessels::left_out() const {
  return std::ranges::any_of(
      std::array{FlatPicture::b_scan, FlatPicture::crossed, FlatPicture::from_above},
      [&](FlatPicture picture) { return !sections_.complete(picture); });
}

} // namespace octascope::ui
