// What the renderer draws a frame from, and how: for renderer.cpp, which answers the calls.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ui/canvas/canvas_renderer.h"
#include "ui/damage/canvas_tiles.h"
#include "ui/damage/damage_history.h"
#include "ui/damage/picture_changes.h"
#include "ui/hud/hud.h"
#include "ui/layout/layout.h"
#include "ui/layout/stereo.h"
#include "ui/panels/b_scan_panel.h"
#include "ui/panels/en_face_panel.h"
#include "ui/panels/field_flow.h"
#include "ui/panels/flow_sections.h"
#include "ui/panels/scope_panel.h"
#include "ui/renderer.h"
#include "ui/scene/volume_painter.h"
#include "ui/vessels/sections/flat_vessels.h"

namespace octascope::ui {

// What one picture was made of.
struct DrawnPicture {
  std::uint64_t volume_uploads = 0;
  std::uint64_t scope_uploads = 0;
  std::uint64_t level_uploads = 0;
  std::uint64_t vessel_uploads = 0;
  int width = 0;
  int height = 0;
  ViewState view;
  DrawQuality quality;
  HudText text;
  bool operator==(const DrawnPicture&) const = default;
};

using RectList = std::span<const Rect>;

// Of the bound framebuffer, that part of it from the lower left.
void clear_to_background(int width, int height);

struct Renderer::Parts {
  VolumePainter volume;
  BScanPanel b_scan_panel;
  EnFacePanel en_face_panel;
  ScopePanel scope_panel;
  CanvasRenderer canvas_renderer;
  Typeface typeface;
  std::optional<FlatVessels> flat_vessels{}; // empty until some are shown
  Canvas ground{};                           // under all pictures
  Canvas under_volume{};                     // which may be an inset
  Canvas overlay{};
  std::optional<Fonts> fonts{};
  float fonts_unit = 0;
  std::vector<pipeline::BScanState> states{};
  StateTexture state_texture{};
  pipeline::VolumeGeometry shown_geometry{};
  TissueMap tissue{};
  SteadyCrop crop{}; // of the flat pictures
  GlidingDepths coloured_depths{};
  std::optional<LevelShares> levels{};
  std::uint64_t level_uploads = 0;
  std::uint64_t scope_uploads = 0;
  std::uint64_t vessel_uploads = 0;
  hal::Duration vessel_cost{}; // of the last draw()
  bool scope_shown = false;
  std::optional<DrawnPicture> drawn{};
  bool drew_volume = false;
  CanvasTiles canvas_tiles{};
  PictureChanges picture_changes{};
  Damage damage{};
  DamageHistory history{};
  // Of a volume with flow.
  bool has_flow = false;
  FlowSections flow_sections{};
  FlowDepths flow_depths{};
  std::optional<FieldFlow> field_flow{}; // empty until there is some
  std::vector<pipeline::FlowState> flow_states{};
  bool completed_by_caller = false; // else:
  pipeline::Volume kept_flow{};     // of which the sections are made

  std::vector<Rect> uncovered{}; // what is to be drawn and not covered by pictures

  ViewState fitted(const ViewState& view) const;
  ViewState without_confusion(const ViewState& view, const Layout& places) const;
  HudScene scene(const ViewState& view) const;
  DrawnPicture picture_of(const ViewState& view, const Status& status, int width, int height,
                          const DrawQuality& quality) const;
  void note(std::span<const pipeline::BScanRange> changed, int b_scans);
  hal::Result<> follow(const pipeline::Volume& shown,
                       std::span<const pipeline::BScanRange> changed);
  hal::Result<> follow_flow(const pipeline::Volume& shown,
                            std::span<const pipeline::BScanRange> changed);
  bool flow_shown(const ViewState& view) const { return has_flow && shows_flow(view); }
  float deepest_flow() const; // as a share of the volume's depth; 0: nothing flows
  FlowShown flow_of(const ViewState& view) const;
  bool has_flow_in_scope(const DrawnPicture& picture) const;
  hal::Duration spent_on_vessels() const;
  Crop crop_of(const ViewState& view) const {
    return view.zoom_to_tissue ? crop.current() : Crop{};
  }
  Layout layout(const DrawnPicture& picture) const;
  hal::Result<> prepare_fonts(float unit);
  void fill_canvases(const DrawnPicture& picture, const Layout& places, const HudScene& shown);
  hal::Result<> draw(const DrawnPicture& picture, const hal::BackBuffer& buffer);
  RectList find_parts(const DrawnPicture& picture, const Layout& places, const EyeFrame& frame,
                      const hal::BackBuffer& buffer);
  void find_uncovered(const Layout& places, const EyeFrame& frame, RectList parts);
  void clear_parts(const DrawnPicture& picture, RectList parts) const;
  hal::Result<> draw_eye(const DrawnPicture& picture, const Layout& places, StereoEye eye,
                         const hal::BackBuffer& buffer);
  void draw_flat_pictures(const ViewState& view, const Layout& places, const EyeFrame& frame,
                          int height, RectList parts);
  VesselSections::Sight sight(const ViewState& view) const;
  hal::Result<> draw_flat_vessels(const ViewState& view, const Layout& places,
                                  const EyeFrame& frame, int height);
  hal::Result<> draw_scope(const DrawnPicture& picture, const Layout& places, const EyeFrame& frame,
                           RectList parts);
  hal::Result<> draw_eye_alone(const ViewState& view, const Layout& places,
                               const DrawQuality& quality, StereoEye eye);
};

} // namespace octascope::ui
