#include "ui/vessels/sections/flat_vessels.h"

#include <algorithm>
#include <utility>

namespace octascope::ui {

namespace {

constexpr float line_width = 1.3F; // at unit 1: as the lines of the positions

FlatPicture picture_of(VesselPanel panel) {
  switch (panel) {
  case VesselPanel::b_scan: return FlatPicture::b_scan;
  case VesselPanel::crossed: return FlatPicture::crossed;
  case VesselPanel::en_face:
  case VesselPanel::microscope: break;
  }
  return FlatPicture::from_above;
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

hal::Result<> FlatVessels::draw(VesselPanel panel, const VesselSections::Sight& sight,
                                const PicturePlace& place, float unit, const Rect& rect,
                                int target_height) {
  const FlatPicture picture = picture_of(panel);
  sections_.update(picture, sight);
  KeptPicture& kept = pictures_[static_cast<std::size_t>(panel)];
  const Key key{sections_.version(picture), place, unit, sight.view.vessel_opacity};
  if (kept.key != key) {
    kept.key.reset();
    const auto marks = sections_.marks(picture);
    kept.empty = marks.empty();
    if (!kept.empty) {
      place_marks(marks, place, placed_);
      const bool cut = picture != FlatPicture::from_above;
      const float reach_px =
          cut ? static_cast<float>(section_reach_mm(sight.geometry)) * place.pixels_per_mm() : 0;
      HAL_CHECK(
          painter_.draw(kept.layer, placed_,
                        {std::max(1.0F, line_width * unit), reach_px, sight.view.vessel_opacity},
                        place.width, place.height));
      ++drawings_;
    }
    kept.key = key;
  }
  if (!kept.empty)
    painter_.blend(kept.layer, rect, target_height);
  return {};
}

bool FlatVessels::left_out() const {
  return std::ranges::any_of(
      std::array{FlatPicture::b_scan, FlatPicture::crossed, FlatPicture::from_above},
      [&](FlatPicture picture) { return !sections_.complete(picture); });
}

} // namespace octascope::ui
