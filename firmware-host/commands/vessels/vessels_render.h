// octascope vessels render: one picture of one vessel tree, without a display.
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "hal/result.h"
#include "pipeline/files/png_image.h"
#include "pipeline/vessels/clusters.h"
#include "ui/vessels/pictures/vessel_methods.h"
#include "ui/vessels/view/vessel_view.h"
#include "ui/view/segment_counts.h"

namespace octascope::firmware_host {

struct VesselsRenderOptions {
  ui::VesselMethodKind method = ui::VesselMethodKind::hybrid;
  ui::TubeShape tubes;
  ui::VesselColouring colouring = ui::VesselColouring::branch;
  std::optional<pipeline::VesselBranch> branch; // empty: all
  // The initial view; the values below change it.
  ui::BenchmarkView view = ui::BenchmarkView::whole;
  std::optional<float> yaw_deg;
  std::optional<float> tilt_deg;
  std::optional<glm::vec3> target_mm;
  std::optional<float> mm_per_pixel;
  float zoom = 1; // magnification
  int width = 1280;
  int height = 720;
};

struct VesselsRendering {
  pipeline::Image picture; // with a scale bar, on the display's background
  ui::SegmentCounts account;
  ui::VesselView view; // as it was drawn
};

// Opens an offscreen GL context for itself and closes it again; none may be current on this thread.
// ErrorCode::invalid_argument: the tree has no segment of that branch. ErrorCode::unsupported: this
// machine has no offscreen GL, or cannot draw by that method.
hal::Result<VesselsRendering> render_vessels(const pipeline::VesselClusters& tree,
                                             const VesselsRenderOptions& options);

} // namespace octascope::firmware_host
