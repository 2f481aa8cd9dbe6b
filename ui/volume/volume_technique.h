// The interface of all techniques that draw the volume by GL.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/threads/work_team.h"
#include "pipeline/volume/occupancy.h"
#include "ui/depth_mask/depth_mask.h"
#include "ui/ray_caster/light_volume.h"
#include "ui/transfer/transfer_texture.h"
#include "ui/view/camera.h"
#include "ui/view/cut.h"
#include "ui/view/view_state.h"
#include "ui/volume/flow_scene.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

// Borrowed for one draw().
struct VolumeScene {
  const VolumeTexture& volume;
  const TransferTexture& transfer; // from levels to colour and opacity
  const Camera& camera;            // for the volume's extents and the target's aspect
  const ViewState& view;
  float step_mm;                                  // distance between samples along the view
  const pipeline::Occupancy* occupancy = nullptr; // of the volume; null: nothing is skipped
  std::uint64_t upload = 0;                       // counts the volumes shown
  std::uint64_t mesh = 0;                         // counts the iso-surfaces
  const DepthMask* vessels = nullptr;             // null: no vessel ends a ray
  CutAway cut_away{};
  const LightVolume* light = nullptr; // of `shaded`; null: nothing is lit
  const FlowScene* flow = nullptr;    // null: nothing of it is drawn
  // In what B-scans the volume differs from that of the upload before; empty: in any.
  std::span<const pipeline::BScanRange> changed{};
  WorkTeam* team = nullptr; // shares what the processor has to prepare; null: there is none
};

// Threads: as gl/objects.h. draw() allocates nothing after the first picture of a size.
class VolumeTechnique {
public:
  virtual ~VolumeTechnique() = default;

  // Draws into the bound framebuffer and viewport, which must have alpha and be cleared to zero,
  // and produces premultiplied colour and opacity. Lengths are physical, opacity is corrected for
  // the step, samples are trilinear, and the transfer function is the scene's. Nothing is drawn
  // behind the nearest vessel of a pixel; with vessels, the viewport must begin in the
  // framebuffer's corner. The scene must have flow if the technique was made for it, and none if not.
  void draw(const VolumeScene& scene) { do_draw(scene); }

  // Whether draw() also writes the distance in mm along the view at which half is hidden, or
  // no_depth (ui/ray_caster/ray_frame.h), into the second colour attachment. If not, that
  // attachment must not be enabled.
  bool writes_depth() const { return do_writes_depth(); }

  // Whether samples are moved by a share of a step that differs from pixel to pixel
  // (ui/dither/dither_mask.h): its picture of few samples is to be softened.
  bool dithers() const { return do_dithers(); }

private:
  virtual void do_draw(const VolumeScene& scene) = 0;
  virtual bool do_writes_depth() const { return false; }
  virtual bool do_dithers() const { return false; }
};

} // namespace octascope::ui
