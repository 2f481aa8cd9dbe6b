// Draws a vessel tree with any method, for measurements.
#pragma once

#include <utility>

#include "hal/result.h"
#include "pipeline/files/png_image.h"
#include "pipeline/vessels/clusters.h"
#include "ui/vessels/pictures/vessel_picture.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/vessels/view/vessel_view.h"
#include "ui/view/segment_counts.h"

namespace octascope::firmware_host {

// Threads: as gl/objects.h. What is borrowed outlives it.
class VesselsBenchPainter {
public:
  VesselsBenchPainter(const pipeline::VesselClusters& tree, ui::VesselPicture picture, int width,
                      int height)
      : tree_{tree}, bounds_{ui::vessel_bounds(tree)}, picture_{std::move(picture)}, width_{width},
        height_{height} {}

  const pipeline::VesselClusters& tree() const { return tree_; }
  int width() const { return width_; }
  int height() const { return height_; }

  // The picture is complete when it returns. `occluded`: as ui::VesselLook.
  hal::Result<ui::SegmentCounts> draw(ui::VesselMethod& method, const ui::VesselView& view,
                                      bool occluded = false);
  // The picture drawn last.
  pipeline::Image read() const { return picture_.read_colour(); }
  // draw() and read().
  hal::Result<pipeline::Image> picture(ui::VesselMethod& method, const ui::VesselView& view,
                                       bool occluded = false);
  // With the eye turned by so many pixels.
  hal::Result<pipeline::Image> picture_beside(ui::VesselMethod& method, const ui::VesselView& view,
                                              float right_px, float up_px);

private:
  ui::Camera camera(const ui::VesselView& view) const;
  hal::Result<ui::SegmentCounts> draw(ui::VesselMethod& method, const ui::VesselView& view,
                                      const ui::Camera& seen, bool occluded);

  const pipeline::VesselClusters& tree_;
  ui::VesselBounds bounds_;
  ui::VesselPicture picture_;
  int width_;
  int height_;
};

} // namespace octascope::firmware_host
