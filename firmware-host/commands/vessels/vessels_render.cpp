#include "firmware-host/commands/vessels/vessels_render.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

#include "firmware-host/commands/offscreen_gl.h"
#include "firmware-host/commands/vessels/vessel_text.h"
#include "ui/gl/framebuffer.h"
#include "ui/scene/vessel_still.h"

namespace octascope::firmware_host {

namespace {

// The tree's clusters of one branch; their nodes are the tree's.
std::vector<pipeline::VesselCluster> clusters_of(const pipeline::VesselClusters& tree,
                                                 pipeline::VesselBranch branch) {
  std::vector<pipeline::VesselCluster> found;
  std::ranges::copy_if(
      tree.clusters, std::back_inserter(found),
      [&](const pipeline::VesselCluster& cluster) { return cluster.branch == branch; });
  return found;
}

pipeline::VesselClusters with_clusters(const pipeline::VesselClusters& tree,
                                       std::span<const pipeline::VesselCluster> clusters) {
  pipeline::VesselClusters part{clusters, tree.nodes, 0};
  for (const pipeline::VesselCluster& cluster : clusters)
    part.segments += cluster.segments();
  return part;
}

ui::VesselView view_of(const VesselsRenderOptions& options, const pipeline::VesselClusters& tree) {
  ui::VesselView view = ui::make_benchmark_view(options.view, tree, options.width, options.height);
  view.yaw_deg = options.yaw_deg.value_or(view.yaw_deg);
  view.tilt_deg = options.tilt_deg.value_or(view.tilt_deg);
  if (options.view == ui::BenchmarkView::whole)
    view = ui::fit_whole_tree(view, tree, options.width, options.height);
  view.target_mm = options.target_mm.value_or(view.target_mm);
  view.mm_per_pixel = options.mm_per_pixel.value_or(view.mm_per_pixel) / options.zoom;
  return view;
}

hal::Result<VesselsRendering> draw(const pipeline::VesselClusters& tree,
                                   const VesselsRenderOptions& options) {
  VesselsRendering made;
  made.view = view_of(options, tree);
  const ui::VesselBounds bounds = ui::vessel_bounds(tree);
  const ui::Camera camera =
      ui::make_vessel_camera(made.view, bounds, options.width, options.height);
  ui::VesselScene scene{tree, camera, glm::mat4{1}, {}, options.width, options.height};
  scene.look.colouring = options.colouring;
  scene.look = ui::with_cue(scene.look, made.view, bounds, options.width, options.height);
  scene.look.occluded = true;
  HAL_TRY(auto method, ui::make_vessel_method(options.method, std::make_shared<ui::NodeTexture>(),
                                              {{}, options.tubes, {}}));
  HAL_TRY(auto still, ui::VesselStill::create());
  HAL_TRY(const auto account, still.draw(*method, scene, made.view.mm_per_pixel));
  made.account = account;
  made.picture = ui::gl::read_framebuffer(options.width, options.height);
  return made;
}

} // namespace

hal::Result<VesselsRendering> render_vessels(const pipeline::VesselClusters& tree,
                                             const VesselsRenderOptions& options) {
  std::vector<pipeline::VesselCluster> of_branch;
  pipeline::VesselClusters shown = tree;
  if (options.branch) {
    of_branch = clusters_of(tree, *options.branch);
    shown = with_clusters(tree, of_branch);
    if (shown.segments == 0)
      return hal::fail(hal::ErrorCode::invalid_argument,
                       "--branch is {}, found no segment of it, expected a branch that the tree "
                       "has; leave the option out to draw all",
                       to_string(*options.branch));
  }
  HAL_TRY(const auto gl, OffscreenGl::open(options.width, options.height));
  return draw(shown, options);
}

} // namespace octascope::firmware_host
