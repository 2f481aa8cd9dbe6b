// Volume pictures on the processor: rays through the volume, front to back.
//
// Source: M. Levoy, "Efficient ray tracing of volume data", ACM Transactions on Graphics 9 (1990):
// early termination, and leaping over empty space. Colour, opacity, blank depths and dither are
// those of stack.frag, so that both draw the same settings.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "pipeline/threads/work_team.h"
#include "pipeline/volume/occupancy.h"
#include "pipeline/volume/volume.h"
#include "ui/depth_mask/depth_image.h"
#include "ui/layout/layout.h"
#include "ui/ray_caster/brick_distances.h"
#include "ui/ray_caster/brick_grid.h"
#include "ui/ray_caster/cell_volume.h"
#include "ui/ray_caster/ray_kernels.h"
#include "ui/ray_caster/step_table.h"
#include "ui/view/camera.h"

namespace octascope::ui {

enum class RayMode : std::uint8_t {
  composite, // colour and opacity, front to back
  shaded,    // the same, lit from the eye on slopes of the level, darker with distance
  maximum    // the highest level along each ray, as opaque as it is bright
};

// Rows from the top.
struct RayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> rgba; // premultiplied; red in the lowest 8 bits
  std::vector<float> depth_mm;     // distance along the view at which half is hidden, or no_depth
  Rect drawn;                      // transparent outside; its border is transparent, too, unless it
                                   // is the image's

  void make_room(int most_wide, int most_high); // up to this size, resize() then allocates nothing
  void resize(int new_width, int new_height);   // allocates only to grow; leaves the image
                                                // transparent
  void draw_into(const Rect& rect);             // sets `drawn` and clears what was drawn outside it
};

struct RaySettings {
  RayMode mode = RayMode::composite;
  float step_mm = 0;                 // along each ray
  bool leap_empty = true;            // affects only speed, not the picture
  const DepthImage* stops = nullptr; // of the same size: where vessels end the rays
};

// Threads: bound to one, but for its own helpers. draw() allocates nothing but the image.
class RayCaster {
public:
  // `helpers` threads besides the caller's. `isa` names an instruction set; empty: the widest.
  // ErrorCode::unsupported: none that this processor has is compiled in.
  static hal::Result<RayCaster> create(std::size_t helpers, const pipeline::ThreadSetup& setup,
                                       std::string_view isa = {});

  // Copies both. ErrorCode::unsupported: too large for 32-bit offsets. ErrorCode::invalid_argument:
  // the occupancy is of another geometry. After an error the last volume stays.
  hal::Result<> show(const pipeline::Volume& volume, const pipeline::Occupancy& occupancy);

  // Takes effect in the next draw(). Does nothing if the table is unchanged.
  void set_transfer(const TransferTable& transfer);

  // The camera is that of ui/view/camera.h for the volume's extents. ErrorCode::invalid_argument:
  // no volume, an image without pixels, a step that is not a positive share of the box, or stops of
  // another size.
  hal::Result<> draw(const Camera& camera, const RaySettings& settings, RayImage& image);

  bool empty() const { return !cells_; }
  const pipeline::VolumeGeometry& geometry() const { return cells_->geometry(); }
  std::string_view isa() const { return kernels_->isa; }
  double occupied_share() const { return bricks_.occupied_share(); }

private:
  RayCaster(const RayKernels& kernels, std::unique_ptr<WorkTeam> team);
  void prepare(float steps, Visibility visibility);
  Rect rectangle_of_box(const Camera& camera, const RayImage& image) const;
  RayFrame frame(const Camera& camera, const RaySettings& settings, RayImage& image) const;

  const RayKernels* kernels_;
  std::unique_ptr<WorkTeam> team_;
  std::optional<CellVolume> cells_;
  pipeline::Occupancy occupancy_;
  std::unique_ptr<TransferTable> transfer_;
  std::unique_ptr<StepTable> steps_table_;
  BrickGrid bricks_;
  DistancesAhead distances_;
  // What table and bricks were made for.
  float steps_ = 0;
  Visibility visibility_ = Visibility::range;
  bool table_current_ = false;
  bool bricks_current_ = false;
};

} // namespace octascope::ui
