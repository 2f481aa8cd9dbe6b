#include "ui/vessels/splatter/splatter.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "ui/vessels/scene/vessel_colour.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

namespace {

constexpr std::uint32_t clusters_at_a_time = 128;
constexpr std::size_t pixels_at_a_time = 1 << 16;
constexpr std::size_t rows_at_a_time = 24;
constexpr std::size_t cell_rows_at_a_time = 12;

BaseColour packed(const VesselColour& colour) {
  const auto bits = [](float v) {
    return static_cast<BaseColour>(std::lround(std::clamp(v, 0.0F, 1.0F) * 1023));
  };
  return bits(colour[0]) | bits(colour[1]) << 10U | bits(colour[2]) << 20U;
}

// dot(direction, world place − eye) for places in the tree's frame.
AffineRow along(const VesselScene& scene, const glm::dvec3& direction) {
  const glm::dmat4 world{scene.world_from_tree};
  const glm::dvec3 offset = glm::dvec3{world[3]} - glm::dvec3{scene.camera.eye};
  return {glm::dot(direction, glm::dvec3{world[0]}), glm::dot(direction, glm::dvec3{world[1]}),
          glm::dot(direction, glm::dvec3{world[2]}), glm::dot(direction, offset)};
}

AffineRow scaled_sum(double p, const AffineRow& a, double q, const AffineRow& b) {
  return {p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2], p * a[3] + q * b[3]};
}

SplatFrame frame_of(const VesselScene& scene, DepthImage& sharp, DepthImage& image) {
  SplatFrame frame;
  frame.tree = scene.tree;
  frame.pixels = sharp.pixels.data();
  frame.smooth = image.pixels.data();
  frame.width = scene.width;
  frame.height = scene.height;
  frame.pixels_per_unit = scene.pixels_per_unit();
  frame.near_mm = scene.camera.near_mm;
  frame.far_mm = scene.camera.far_mm;
  frame.look = scene.look;
  const double scale = scene.pixels_per_unit();
  const double middle_column = 0.5 * scene.width - 0.5 - scale * double{scene.camera.centre_shift};
  const double middle_line = 0.5 * scene.height - 0.5;
  frame.middle_column = static_cast<float>(middle_column);
  frame.middle_line = static_cast<float>(middle_line);
  frame.distance_row = along(scene, scene.camera.forward);
  frame.column_row =
      scaled_sum(scale, along(scene, scene.camera.right), middle_column, frame.distance_row);
  frame.line_row =
      scaled_sum(-scale, along(scene, scene.camera.up), middle_line, frame.distance_row);
  for (std::size_t branch = 0; branch < frame.colours.size(); ++branch)
    for (std::size_t order = 0; order < pipeline::vessel_order_count; ++order)
      frame.colours[branch][order] =
          packed(colour_of(scene.look.colouring, branch, order, drawn_by_processor)) |
          (order >= least_order_kept_visible ? kept_visible : 0);
  return frame;
}

// The highest bit is for all columns that follow, too.
SplatColumns columns_of(std::uint64_t blocks, int width) {
  if (blocks == 0)
    return {};
  const auto end = static_cast<int>(std::bit_width(blocks));
  return {smoothing_block * std::countr_zero(blocks),
          end == 64 ? width : std::min(smoothing_block * end, width)};
}

template <class Work>
void in_parts(WorkTeam& team, std::size_t count, std::size_t at_a_time, const Work& work) {
  team.run(static_cast<std::uint32_t>((count + at_a_time - 1) / at_a_time), [&](std::uint32_t i) {
    const std::size_t first = i * at_a_time;
    work(first, std::min(first + at_a_time, count));
  });
}

} // namespace

hal::Result<Splatter> Splatter::create(std::size_t helpers, const pipeline::ThreadSetup& setup,
                                       std::string_view isa) {
  const SplatKernels* kernels = splat_kernels(isa);
  if (kernels == nullptr)
    return hal::fail(hal::ErrorCode::unsupported,
                     "vessel splatter: found no instruction set {}of those compiled in on this "
                     "processor; draw vessels with GL",
                     isa.empty() ? std::string{} : fmt::format("'{}' ", isa));
  return Splatter{*kernels, std::make_unique<WorkTeam>(helpers, setup)};
}

OcclusionMoments Splatter::occlude(const VesselScene& scene) {
  occlusion_.resize(scene.width, scene.height, scene.look.cue_near_mm);
  const auto rows = static_cast<std::size_t>(occlusion_.rows());
  in_parts(*team_, rows, cell_rows_at_a_time, [&](std::size_t first, std::size_t end) {
    occlusion_.gather(sharp_, static_cast<int>(first), static_cast<int>(end));
  });
  in_parts(*team_, rows, cell_rows_at_a_time, [&](std::size_t first, std::size_t end) {
    occlusion_.spread(static_cast<int>(first), static_cast<int>(end));
  });
  return occlusion_.moments();
}

hal::Result<SegmentCounts> Splatter::draw(const VesselScene& scene, DepthImage& image,
                                          const SplatShare& share) {
  if (scene.width <= 0 || scene.height <= 0)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "vessel splatter: a picture of {} by {} pixels, expected at least one; give "
                     "the window a size",
                     scene.width, scene.height);
  if (!share.taken.empty() && share.taken.size() != scene.tree.clusters.size())
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "vessel splatter: shares of {} clusters, expected {}; give one for each cluster or none",
        share.taken.size(), scene.tree.clusters.size());
  image.resize(scene.width, scene.height);
  sharp_.resize(scene.width, scene.height);
  const auto pixels =
      static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height);
  if (sharp_.pixels.size() < pixels + spare_pixels)
    sharp_.pixels.resize(pixels + spare_pixels);
  in_parts(*team_, pixels, pixels_at_a_time, [&](std::size_t first, std::size_t end) {
    std::fill(sharp_.pixels.begin() + static_cast<std::ptrdiff_t>(first),
              sharp_.pixels.begin() + static_cast<std::ptrdiff_t>(end), empty_depth_pixel);
  });
  SplatFrame frame = frame_of(scene, sharp_, image);
  frame.taken = share.taken;
  frame.detail_px = share.detail_px;
  frame.within_volume = share.within_volume;
  std::atomic<std::uint64_t> splatted{0};
  std::atomic<std::uint64_t> merged{0};
  std::atomic<std::uint64_t> culled{0};
  in_parts(*team_, scene.tree.clusters.size(), clusters_at_a_time,
           [&](std::size_t first, std::size_t end) {
             const SplatCounts counts = kernels_->splat(frame, static_cast<std::uint32_t>(first),
                                                        static_cast<std::uint32_t>(end));
             splatted.fetch_add(counts.splatted, std::memory_order_relaxed);
             merged.fetch_add(counts.merged, std::memory_order_relaxed);
             culled.fetch_add(counts.culled, std::memory_order_relaxed);
           });
  if (scene.look.occluded)
    frame.occlusion = occlude(scene);
  std::atomic<std::uint64_t> blocks{0};
  in_parts(*team_, static_cast<std::size_t>(scene.height), rows_at_a_time,
           [&](std::size_t top, std::size_t bottom) {
             blocks.fetch_or(
                 kernels_->smooth(frame, static_cast<int>(top), static_cast<int>(bottom)),
                 std::memory_order_relaxed);
           });
  columns_ = columns_of(blocks, scene.width);
  return SegmentCounts{0, splatted, merged, culled};
}

} // namespace octascope::ui
