#include "ui/controls/view_text.h"

namespace octascope::ui {

std::string_view words_for(Technique technique) {
  switch (technique) {
  case Technique::slices: return "slices";
  case Technique::planes: return "planes";
  case Technique::rays: return "rays";
  case Technique::shaded: return "shaded rays";
  case Technique::maximum: return "maximum intensity";
  case Technique::surface: return "surface";
  }
  return "rays";
}

std::string_view words_for(LayoutKind layout) {
  switch (layout) {
  case LayoutKind::volume: return "volume";
  case LayoutKind::b_scan: return "B-scan";
  case LayoutKind::microscope: return "microscope";
  case LayoutKind::quad: return "quad";
  }
  return "volume";
}

std::string_view words_for(StereoMode mode) {
  switch (mode) {
  case StereoMode::off: return "off";
  case StereoMode::side_by_side: return "side by side";
  case StereoMode::top_bottom: return "top and bottom";
  }
  return "off";
}

std::string_view words_for(VesselColouring colouring) {
  switch (colouring) {
  case VesselColouring::branch: return "main branches";
  case VesselColouring::order: return "orders";
  case VesselColouring::diagnostic: return "who drew them";
  }
  return "main branches";
}

std::string_view words_of(const ViewState& view, const ChoiceNames& names, Action action) {
  const auto shown = [](bool visible) { return visible ? "shown" : "hidden"; };
  switch (action) {
  case Action::technique: return words_for(view.technique);
  case Action::transfer: return names.transfers[static_cast<std::size_t>(view.transfer)];
  case Action::colours: return names.colours[static_cast<std::size_t>(view.colour_map)];
  case Action::layout: return words_for(view.layout);
  case Action::stereo: return words_for(view.stereo);
  case Action::freeze: return view.frozen ? "frozen" : "live";
  case Action::vessel_colours: return words_for(view.vessel_colouring);
  case Action::vessel_account: return shown(view.vessel_account);
  case Action::keep_registration:
  case Action::reset_registration:
    return view.vessel_nudge.any() ? "turn right to do it" : "not moved";
  case Action::vessels: return shown(view.vessels_visible);
  case Action::box: return shown(view.box_visible);
  case Action::legend: return shown(view.legend_visible);
  default: return {};
  }
}

} // namespace octascope::ui
