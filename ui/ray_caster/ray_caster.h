// Draws volumes on the processor: ray casting, front to back.
//
// Source of the technique: M. Levoy, "Efficient ray tracing of volume data", ACM Transactions on
// Graphics 9 (1990): early termination and skipping of empty space. Colour, opacity, blank depths
// and dither are those of stack.frag, so that both draw the same picture for the same settings.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "pipeline/threads/work_team.h"
#include "pipeline/volume/occupancy.h"
#include "pipeline/volume/volume.h"
#include "ui/bricks/brick_distances.h"
#include "ui/bricks/brick_grid.h"
#include "ui/depth_mask/depth_image.h"
#include "ui/layout/layout.h"
#include "ui/ray_caster/cell_volume.h"
#include "ui/ray_caster/flow_cells.h"
#include "ui/ray_caster/light_volume.h"
#include "ui/ray_caster/projected_slab.h"
#include "ui/ray_caster/ray_kernels.h"
#include "ui/ray_caster/step_table.h"
#include "ui/view/camera.h"
#include "ui/view/cut.h"

namespace octascope::ui {

enum class RayMode : std::uint8_t {
  composite, // colour and opacity, front to back
  shaded,    // the same, lit by a lamp (light_volume.h), darker with distance
  maximum    // the highest level along each ray, as opaque as it is bright
};

// Rows from the top.
struct RayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> rgba;    // premultiplied; red in the lowest 8 bits
  std::vector<std::uint32_t> grained; // the same before it was softened, in `drawn`
  std::vector<float> depth_mm; // distance along the view to where half is hidden, or no_depth
  Rect drawn;                  // everything outside is transparent, and so is its border,
                               // except at the image's own border
  Rect renewed;                // of `drawn`: what the last draw() may have changed

  void make_room(int most_wide, int most_high); // resize() up to this then allocates nothing
  void resize(int new_width, int new_height);   // allocates only to grow; leaves it transparent
  void draw_into(const Rect& rect);             // clears what was drawn outside of `rect`
};

// What flows in a volume, in the order of its levels, and where. Borrowed.
struct FlowVoxels {
  std::span<const std::uint8_t> counts; // pipeline/volume/flow_scale.h
  const pipeline::FlowMarks* marks = nullptr;
};

struct RaySettings {
  RayMode mode = RayMode::composite;
  float step_mm = 0;      // along each ray
  bool leap_empty = true; // affects only the drawing time, not the picture
  CutAway cut_away{};
  const DepthImage* stops = nullptr;  // of the image's size: where vessels end the rays
  const LightVolume* light = nullptr; // of `shaded`, prepared; null: nothing is lit
  bool soften = false;                // ui/dither/soften.h
  // Of what flows for certain, over one reference step (ui/transfer/flow_look.h); nothing: flow is not
  // drawn.
  std::optional<float> flow_opacity{};
  // With flow, for `composite`: of the tissue, one sample in eight is taken for all eight. It is a haze
  // then (tissue_beside_flow), so that a picture changes little. Of what flows, all samples are.
  bool coarse_beside_flow = false;
  // Not empty: since the same picture was drawn into this image, the volume has changed in these
  // B-scans alone (the stops are the same, no light is used). Only rays that may meet them are cast.
  std::span<const pipeline::BScanRange> changed{};
};

// Threads: bound to one, except for the team's helpers. draw() allocates only the image.
class RayCaster {
public:
  // `team` shares the work. `isa` names an instruction set; by default the widest is used.
  // ErrorCode::unsupported: none of the compiled ones is available on this processor.
  static hal::Result<RayCaster> create(std::shared_ptr<WorkTeam> team, std::string_view isa = {});

  // Copies both. ErrorCode::unsupported: too large for 32-bit offsets. ErrorCode::invalid_argument:
  // the occupancy has another geometry. On errors the previous volume stays.
  // `prepare` is called with each B-scan before it is copied, by one of the threads; it may make that
  // B-scan's marks of flow, too. `flow`: null without.
  hal::Result<> show(const pipeline::Volume& volume, const pipeline::Occupancy& occupancy,
                     const std::function<void(int)>& prepare = {},
                     const FlowVoxels* flow = nullptr);

  // The same where they differ from those shown last in these B-scans alone.
  hal::Result<> renew(const pipeline::Volume& volume, const pipeline::Occupancy& occupancy,
                      std::span<const pipeline::BScanRange> changed,
                      const std::function<void(int)>& prepare = {},
                      const FlowVoxels* flow = nullptr);

  // Takes effect with the next draw(). Setting an equal table again costs only the comparison.
  void set_transfer(const TransferTable& transfer);

  // The camera must be that of ui/view/camera.h for the volume's extents.
  // ErrorCode::invalid_argument: there is no volume, the image has no pixels, the step is not a
  // positive share of the box, the stops are of another size, or flow is to be drawn and was not shown.
  hal::Result<> draw(const Camera& camera, const RaySettings& settings, RayImage& image);

  // Whether the last draw() may have changed pixels of its image there: false only of a renewal.
  bool may_have_changed(const Rect& pixels) const;

  bool empty() const { return !cells_; }
  bool has_flow() const { return has_flow_; } // the volume shown, as far as it was given
  const pipeline::VolumeGeometry& geometry() const { return cells_->geometry(); }
  std::string_view isa() const { return kernels_->isa; }
  double occupied_share() const { return bricks_.occupied_share(); }

private:
  RayCaster(const RayKernels& kernels, std::shared_ptr<WorkTeam> team);
  void copy_b_scans(const pipeline::Volume& volume, const pipeline::BScanRange& range,
                    const std::function<void(int)>& prepare, const FlowVoxels* flow);
  void take_flow(const FlowVoxels& flow, const pipeline::BScanRange& range);
  void make_stale(const pipeline::BScanRange& b_scans);
  hal::Result<> check(const Camera& camera, const RaySettings& settings,
                      const RayImage& image) const;
  void prepare(const RaySettings& settings);
  void prepare_tables(const RaySettings& settings);
  RayKernels::Draw kernel(const RaySettings& settings) const;
  void find_slabs(const Camera& camera, const RaySettings& settings, RayImage& image);
  Rect rectangle_of_box(const Camera& camera, const RayImage& image) const;
  void soften(const RaySettings& settings, RayImage& image);
  RayFrame frame(const Camera& camera, const RaySettings& settings, RayImage& image) const;

  const RayKernels* kernels_;
  std::shared_ptr<WorkTeam> team_;
  std::optional<CellVolume> cells_;
  pipeline::Occupancy occupancy_;
  std::unique_ptr<TransferTable> transfer_;
  std::unique_ptr<StepTable> steps_table_;
  BrickGrid bricks_;
  DistancesAhead distances_;
  // What flows. The cells stay allocated while volumes without are shown.
  FlowCells flow_cells_;
  pipeline::FlowMarks flow_marks_;
  bool has_flow_ = false;
  std::unique_ptr<FlowTable> flow_table_; // made when flow is first drawn, for:
  float flow_opacity_ = 0;
  float flow_steps_ = 0;
  BrickGrid flow_bricks_;
  DistancesAhead flow_distances_;
  // The inputs of the current table and bricks.
  float steps_ = 0;
  Visibility visibility_ = Visibility::range;
  bool bricks_with_flow_ = false;
  bool table_current_ = false;
  bool bricks_current_ = false;     // but for the rows that are stale
  std::vector<std::uint8_t> stale_; // by row of bricks
  bool any_stale_ = false;
  std::vector<ProjectedSlab> slabs_; // of what changed, in the last draw(); empty: everything
};

} // namespace octascope::ui
