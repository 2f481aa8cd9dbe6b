// One vessel tree, drawn by any method and read back.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "ui/vessels/pictures/vessel_methods.h"
#include "ui/vessels/pictures/vessel_picture.h"
#include "ui/vessels/view/vessel_view.h"
#include "ui/view/segment_counts.h"

namespace octascope::tests {

struct DrawnVessels {
  pipeline::Image colour;
  std::vector<float> depth; // of the window, 0…1
  ui::SegmentCounts account;

  bool covered(std::size_t pixel) const { return depth[pixel] < 1; }
};

// Of what the window's depth says, 0…1, along the view.
inline double distance_mm(const ui::Camera& camera, float depth) {
  const double near = camera.near_mm;
  const double far = camera.far_mm;
  return near * far / (far - double{depth} * (far - near));
}

// Needs a current context.
class VesselStage {
public:
  static constexpr int width = 320;
  static constexpr int height = 180;
  static constexpr int sectors = 16; // of tubes

  explicit VesselStage(const pipeline::VesselTree& tree);

  // Stays the stage's; with its pictures' colours.
  ui::VesselScene scene(const ui::VesselView& view,
                        ui::VesselColouring colouring = ui::VesselColouring::branch);
  DrawnVessels draw(ui::VesselMethod& method, const ui::VesselScene& scene);

  ui::VesselView whole() const;
  ui::VesselMethod& method(ui::VesselMethodKind kind,
                           ui::ClusterChoice choice = ui::ClusterChoice::visible);
  const pipeline::VesselClusters& tree() const { return view_; }

private:
  pipeline::ClusterArrays arrays_;
  pipeline::VesselClusters view_;
  ui::VesselBounds bounds_;
  ui::Camera camera_;
  std::shared_ptr<ui::NodeTexture> nodes_;
  std::optional<ui::VesselPicture> picture_;
  std::map<std::pair<ui::VesselMethodKind, ui::ClusterChoice>, std::unique_ptr<ui::VesselMethod>>
      methods_;
};

// Those that GL draws.
inline constexpr std::array drawn_methods{
    ui::VesselMethodKind::tubes_gpu, ui::VesselMethodKind::tubes_cpu,
    ui::VesselMethodKind::quads_gpu, ui::VesselMethodKind::quads_cpu,
    ui::VesselMethodKind::balanced};

} // namespace octascope::tests
