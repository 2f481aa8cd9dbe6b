#include "ui/ray_caster/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "ui/dither/dither_mask.h"
#include "ui/dither/soften.h"
#include "ui/ray_caster/ray_geometry.h"
#include "ui/view/plane_box.h"

namespace octascope::ui {

namespace {

void set(float (&to)[3], const glm::vec3& from) {
  for (int i = 0; i < 3; ++i)
    to[i] = from[i];
}

void set_light(RayFrame& frame, const LightVolume& light) {
  const LightVolume::Counts& n = light.counts();
  const std::int32_t counts[3] = {n.depth, n.a, n.b};
  frame.light = light.texels().data();
  std::int32_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    frame.light_axes[axis] = {light.texel_scale()[axis], light.texel_offset()[axis], counts[axis],
                              stride};
    stride *= counts[axis];
  }
}

Rect united(const Rect& a, const Rect& b) {
  const int x = std::min(a.x, b.x);
  const int y = std::min(a.y, b.y);
  return {x, y, std::max(a.right(), b.right()) - x, std::max(a.bottom(), b.bottom()) - y};
}

// The tiles of `drawn` that `bounds` meets, and what is softened with them.
Rect tiles_around(const Rect& bounds, const Rect& drawn) {
  const auto before = [](int at, int origin, int least) {
    const int tile = (std::max(at, origin) - origin) / tile_size * tile_size + origin;
    return std::max(tile - soften_radius, least);
  };
  const auto behind = [](int at, int origin, int most) {
    const int tiles = (std::max(at, origin) - origin + tile_size - 1) / tile_size;
    return std::min(origin + tiles * tile_size + soften_radius, most);
  };
  const int x = before(bounds.x, drawn.x, drawn.x);
  const int y = before(bounds.y, drawn.y, drawn.y);
  return {x, y, std::max(behind(bounds.right(), drawn.x, drawn.right()) - x, 0),
          std::max(behind(bounds.bottom(), drawn.y, drawn.bottom()) - y, 0)};
}

} // namespace

// Written once, so that the memory is there and not only promised.
void RayImage::make_room(int most_wide, int most_high) {
  const auto pixels = static_cast<std::size_t>(most_wide) * static_cast<std::size_t>(most_high);
  if (rgba.capacity() < pixels)
    resize(most_wide, most_high);
}

void RayImage::resize(int new_width, int new_height) {
  width = new_width;
  height = new_height;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  rgba.assign(pixels, 0);
  grained.assign(pixels, 0);
  depth_mm.assign(pixels, no_depth);
  drawn = {};
}

void RayImage::draw_into(const Rect& rect) {
  for (int y = drawn.y; y < drawn.bottom(); ++y) {
    const bool shared = y >= rect.y && y < rect.bottom();
    const auto clear = [&](int from, int to) {
      const auto row = static_cast<std::ptrdiff_t>(y) * width;
      if (from < to) {
        std::fill(rgba.begin() + row + from, rgba.begin() + row + to, 0U);
        std::fill(depth_mm.begin() + row + from, depth_mm.begin() + row + to, no_depth);
      }
    };
    clear(drawn.x, shared ? std::min(drawn.right(), rect.x) : drawn.right());
    if (shared)
      clear(std::max(drawn.x, rect.right()), drawn.right());
  }
  drawn = rect;
}

hal::Result<RayCaster> RayCaster::create(std::shared_ptr<WorkTeam> team, std::string_view isa) {
  const RayKernels* kernels = ray_kernels(isa);
  if (kernels == nullptr)
    return hal::fail(hal::ErrorCode::unsupported,
                     fmt::format("ray caster: this processor has no {}; let GL draw the volume",
                                 isa.empty() ? "instruction set that it is compiled for" : isa));
  return RayCaster{*kernels, std::move(team)};
}

RayCaster::RayCaster(const RayKernels& kernels, std::shared_ptr<WorkTeam> team)
    : kernels_{&kernels}, team_{std::move(team)}, transfer_{std::make_unique<TransferTable>()},
      steps_table_{std::make_unique<StepTable>()} {
  constexpr std::size_t most_slabs = 8;
  slabs_.reserve(most_slabs);
}

void RayCaster::copy_b_scans(const pipeline::Volume& volume, const pipeline::BScanRange& range,
                             const std::function<void(int)>& prepare, const FlowVoxels* flow) {
  team_->run(static_cast<std::uint32_t>(range.to - range.from), [&](std::uint32_t i) {
    const int b = range.from + static_cast<int>(i);
    if (prepare)
      prepare(b);
    cells_->update(b, volume.b_scan(b));
    if (flow != nullptr)
      flow_marks_.copy(b, *flow->marks);
  });
  if (flow != nullptr)
    take_flow(*flow, range);
}

// Once the marks are there; of the neighbours, too, whose cells reach into what changed.
void RayCaster::take_flow(const FlowVoxels& flow, const pipeline::BScanRange& range) {
  const std::size_t size = cells_->geometry().b_scan_voxels();
  const int from = std::max(range.from - 1, 0);
  const int to = std::min(range.to + 1, cells_->geometry().b_scans);
  team_->run(static_cast<std::uint32_t>(to - from), [&](std::uint32_t i) {
    const int b = from + static_cast<int>(i);
    flow_cells_.take(b, flow.counts.subspan(static_cast<std::size_t>(b) * size, size), flow_marks_);
  });
}

hal::Result<> RayCaster::show(const pipeline::Volume& volume, const pipeline::Occupancy& occupancy,
                              const std::function<void(int)>& prepare, const FlowVoxels* flow) {
  const pipeline::VolumeGeometry& g = volume.geometry;
  if (!CellVolume::fits(g) || volume.levels.size() != g.voxels())
    return hal::fail(hal::ErrorCode::unsupported,
                     fmt::format("ray caster: found {} levels of {} depths x {} A-scans x {} "
                                 "B-scans, expected a whole volume below 1 GiB; scan fewer",
                                 volume.levels.size(), g.depths, g.a_scans, g.b_scans));
  if (occupancy.geometry() != g)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     fmt::format("ray caster: found the occupancy of a volume of {} depths x {} "
                                 "A-scans x {} B-scans, expected that of {} x {} x {}",
                                 occupancy.geometry().depths, occupancy.geometry().a_scans,
                                 occupancy.geometry().b_scans, g.depths, g.a_scans, g.b_scans));
  if (!cells_ || cells_->geometry() != g)
    cells_.emplace(g);
  if (flow != nullptr && flow_cells_.geometry() != g) {
    flow_cells_ = FlowCells{g};
    flow_marks_ = *flow->marks;
  }
  has_flow_ = flow != nullptr;
  occupancy_ = occupancy;
  copy_b_scans(volume, {0, g.b_scans}, prepare, flow);
  bricks_current_ = false;
  return {};
}

hal::Result<> RayCaster::renew(const pipeline::Volume& volume, const pipeline::Occupancy& occupancy,
                               std::span<const pipeline::BScanRange> changed,
                               const std::function<void(int)>& prepare, const FlowVoxels* flow) {
  const pipeline::VolumeGeometry& g = volume.geometry;
  if (!cells_ || cells_->geometry() != g || occupancy.geometry() != g ||
      has_flow_ != (flow != nullptr))
    return show(volume, occupancy, prepare, flow);
  for (const pipeline::BScanRange& range : changed) {
    for (int b = range.from; b < range.to; ++b)
      occupancy_.copy(b, occupancy);
    copy_b_scans(volume, range, prepare, flow);
    make_stale(range);
  }
  return {};
}

// A B-scan's cells are those on either side of it.
void RayCaster::make_stale(const pipeline::BScanRange& b_scans) {
  stale_.resize(static_cast<std::size_t>(occupancy_.bricks().b));
  const auto from = stale_.begin() + (b_scans.from >> pipeline::brick_b_shift);
  const auto to =
      stale_.begin() + std::min(b_scans.to >> pipeline::brick_b_shift, occupancy_.bricks().b - 1);
  std::fill(from, to + 1, std::uint8_t{1});
  any_stale_ = true;
}

void RayCaster::set_transfer(const TransferTable& transfer) {
  transfer_->depths = transfer.depths;
  if (transfer.opacity == transfer_->opacity && transfer.colour == transfer_->colour)
    return;
  *transfer_ = transfer;
  table_current_ = false;
}

void RayCaster::prepare_tables(const RaySettings& settings) {
  const float steps = settings.step_mm / reference_step_mm(box_extents_mm(geometry()) / 2.0F);
  if (!table_current_ || steps != steps_) {
    make_step_table(*transfer_, steps, *steps_table_);
    steps_ = steps;
    bricks_current_ = bricks_current_ && table_current_; // the same levels are empty at any step
    table_current_ = true;
  }
  if (!settings.flow_opacity ||
      (flow_table_ && flow_opacity_ == *settings.flow_opacity && flow_steps_ == steps))
    return;
  if (!flow_table_)
    flow_table_ = std::make_unique<FlowTable>();
  make_flow_table(*settings.flow_opacity, steps, *flow_table_);
  flow_opacity_ = *settings.flow_opacity;
  flow_steps_ = steps;
}

void RayCaster::prepare(const RaySettings& settings) {
  prepare_tables(settings);
  const Visibility visibility = !settings.leap_empty                ? Visibility::everything
                                : settings.mode == RayMode::maximum ? Visibility::maximum
                                                                    : Visibility::range;
  const bool with_flow = settings.flow_opacity.has_value();
  const bool all = !bricks_current_ || visibility != visibility_ || with_flow != bricks_with_flow_;
  if (!all && !any_stale_)
    return;
  const auto stale = all ? std::span<const std::uint8_t>{} : stale_;
  if (with_flow) {
    flow_bricks_.update_flow(flow_marks_, !settings.leap_empty, team_.get(), stale);
    flow_distances_.forget();
  }
  // The maximum of flow is looked for on its own.
  const bool join = with_flow && visibility == Visibility::range;
  bricks_.update(occupancy_, steps_table_->visible, visibility, team_.get(), stale,
                 join ? &flow_bricks_ : nullptr);
  distances_.forget();
  std::ranges::fill(stale_, std::uint8_t{0});
  any_stale_ = false;
  visibility_ = visibility;
  bricks_with_flow_ = with_flow;
  bricks_current_ = true;
}

RayFrame RayCaster::frame(const Camera& camera, const RaySettings& settings,
                          RayImage& image) const {
  const pipeline::VolumeGeometry& g = cells_->geometry();
  const RayGeometry rays = ray_geometry(g, camera, settings.cut_away);
  RayFrame f{};
  f.cells = cells_->data();
  f.column_bytes = cells_->column_bytes();
  f.row_bytes = cells_->row_bytes();
  f.bricks = distances_.data();
  f.brick_row = bricks_.counts().depth;
  f.brick_slab = bricks_.counts().depth * bricks_.counts().a;
  f.brick_octant = static_cast<std::int32_t>(bricks_.counts().all());
  set(f.lower, rays.lower);
  set(f.upper, rays.upper);
  f.is_cut = rays.is_cut;
  f.cut[0] = rays.cut.x;
  f.cut[1] = rays.cut.y;
  if (settings.flow_opacity) {
    f.flow = flow_cells_.counts();
    f.flow_column = flow_cells_.column_bytes();
    f.flow_slab = flow_cells_.slab_bytes();
    f.last_a = g.a_scans - 1;
    f.last_b = g.b_scans - 1;
    f.flow_marks = flow_cells_.marks();
    f.mark_row = flow_cells_.mark_row();
    f.mark_slab = flow_cells_.mark_slab();
    f.flow_bricks = flow_distances_.data();
    f.flow_opacity_and_weight = flow_table_->opacity_and_weight.data();
    f.coarse_beside_flow = settings.coarse_beside_flow && settings.mode == RayMode::composite;
  }
  f.opacity_and_red = steps_table_->opacity_and_red.data();
  f.green_and_blue = steps_table_->green_and_blue.data();
  if (const auto& ramp = steps_table_->ramp) {
    f.ramp_scale = ramp->window.scale / 255;
    f.ramp_offset = ramp->window.offset;
    std::ranges::copy(ramp->opacity, f.ramp_opacity);
  }

  if (const auto& depths = transfer_->depths) {
    f.by_depth = true;
    // The middle of depth bin 0 is at 0.
    f.tint_scale = 1 / (static_cast<float>(g.depths) * (depths->to - depths->from));
    f.tint_offset = 0.5F * f.tint_scale - depths->from / (depths->to - depths->from);
  }
  set(f.eye, rays.eye);
  set(f.forward, rays.forward);
  set(f.right, rays.right);
  set(f.up, rays.up);
  f.pixel_height = 2 * camera.tan_half_height / static_cast<float>(image.height);
  f.pixel_width = 2 * camera.tan_half_height * camera.aspect / static_cast<float>(image.width);
  f.centre_shift = camera.centre_shift;
  f.near_mm = camera.near_mm;
  f.step_mm = settings.step_mm;
  f.dither = dither_mask().data();

  if (settings.light != nullptr)
    set_light(f, *settings.light);
  set(f.lamp, rays.lamp);
  set(f.mm, rays.mm);
  f.cue_near_mm = rays.cue_near_mm;
  f.cue_per_mm = rays.cue_per_mm;

  f.width = image.width;
  f.height = image.height;
  f.rgba = settings.soften ? image.grained.data() : image.rgba.data();
  f.depth_mm = image.depth_mm.data();
  f.stops = settings.stops != nullptr ? settings.stops->pixels.data() : nullptr;
  return f;
}

hal::Result<> RayCaster::check(const Camera& camera, const RaySettings& settings,
                               const RayImage& image) const {
  // Positions have 16 bits after the point: more samples than these would drift.
  constexpr float most_samples = 16384;
  const float diagonal = cells_ ? glm::length(box_extents_mm(geometry())) : 0;
  if (!cells_ || image.width < 1 || image.height < 1 ||
      !(settings.step_mm * most_samples >= diagonal) || !(settings.step_mm <= diagonal) ||
      !(camera.aspect > 0))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     fmt::format("ray caster: found an image of {}x{} with an aspect of {} and a "
                                 "step of {} mm, expected pixels and a step of {} to {} mm",
                                 image.width, image.height, camera.aspect, settings.step_mm,
                                 diagonal / most_samples, diagonal));
  if (settings.stops != nullptr &&
      (settings.stops->width != image.width || settings.stops->height != image.height))
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        fmt::format("ray caster: found vessels of {}x{} pixels, expected as many as of "
                    "the volume's picture, {}x{}",
                    settings.stops->width, settings.stops->height, image.width, image.height));
  if (settings.flow_opacity && !has_flow_)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "ray caster: flow is to be drawn, expected it to be shown with the volume");
  return {};
}

RayKernels::Draw RayCaster::kernel(const RaySettings& settings) const {
  const auto look = static_cast<std::size_t>(transfer_->depths    ? Look::by_depth
                                             : steps_table_->ramp ? Look::ramp
                                             : steps_table_->grey ? Look::grey
                                                                  : Look::coloured);
  const RayKernels::Modes& modes = settings.flow_opacity ? kernels_->with_flow : kernels_->plain;
  return settings.mode == RayMode::maximum  ? modes.maximum
         : settings.mode == RayMode::shaded ? modes.shaded[look]
                                            : modes.composite[look];
}

hal::Result<> RayCaster::draw(const Camera& camera, const RaySettings& settings, RayImage& image) {
  HAL_CHECK(check(camera, settings, image));
  prepare(settings);
  const RayKernels::Draw draw_tile = kernel(settings);
  const unsigned octants = octants_of_rays(geometry(), camera);
  if (settings.flow_opacity)
    flow_distances_.measure(flow_bricks_, octants, team_.get());
  distances_.measure(bricks_, octants, team_.get());
  const RayFrame rays = frame(camera, settings, image);
  image.draw_into(rectangle_of_box(camera, image));
  find_slabs(camera, settings, image);
  const int across = (image.drawn.width + tile_size - 1) / tile_size;
  const int down = (image.drawn.height + tile_size - 1) / tile_size;
  team_->run(static_cast<std::uint32_t>(across * down), [&](std::uint32_t tile) {
    const int index = static_cast<int>(tile);
    const Tile at{image.drawn.x + index % across * tile_size,
                  image.drawn.y + index / across * tile_size};
    if (may_have_changed({at.x, at.y, tile_size, tile_size}))
      draw_tile(rays, at);
  });
  if (settings.soften)
    soften(settings, image);
  return {};
}

void RayCaster::find_slabs(const Camera& camera, const RaySettings& settings, RayImage& image) {
  slabs_.clear();
  image.renewed = image.drawn;
  Rect bounds;
  for (const pipeline::BScanRange& range : settings.changed) {
    const auto slab = project_slab(geometry(), range, camera, image.width, image.height);
    if (!slab) { // it reaches behind the eye
      slabs_.clear();
      return;
    }
    if (slabs_.size() == slabs_.capacity()) { // as good as everywhere
      slabs_.clear();
      return;
    }
    slabs_.push_back(*slab);
    bounds = bounds.empty() ? slab->bounds() : united(bounds, slab->bounds());
  }
  if (!slabs_.empty())
    image.renewed = tiles_around(bounds, image.drawn);
}

bool RayCaster::may_have_changed(const Rect& pixels) const {
  return slabs_.empty() || std::ranges::any_of(slabs_, [&](const ProjectedSlab& slab) {
           return slab.may_meet(pixels);
         });
}

void RayCaster::soften(const RaySettings& settings, RayImage& image) {
  constexpr int rows = 16; // at a time
  const SoftenJob job{image.grained, image.rgba, image.width, image.drawn, settings.stops};
  const Rect& renewed = image.renewed;
  team_->run(static_cast<std::uint32_t>((renewed.height + rows - 1) / rows),
             [&](std::uint32_t piece) {
               const int first = renewed.y + static_cast<int>(piece) * rows;
               soften_rows(job, first, std::min(first + rows, renewed.bottom()));
             });
}

// Whole tiles, with two pixels to spare around the volume's box.
Rect RayCaster::rectangle_of_box(const Camera& camera, const RayImage& image) const {
  const glm::vec3 half = box_extents_mm(geometry()) / 2.0F;
  glm::vec2 lower{std::numeric_limits<float>::max()};
  glm::vec2 upper{std::numeric_limits<float>::lowest()};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 sign{(corner & 1) * 2 - 1, (corner & 2) - 1, (corner & 4) / 2 - 1};
    const glm::vec3 at = half * sign;
    if (camera.depth_of(at) <= camera.near_mm)
      return {0, 0, image.width, image.height};
    const glm::vec2 place = camera.project(at);
    lower = glm::min(lower, place);
    upper = glm::max(upper, place);
  }
  const auto height = static_cast<float>(image.height);
  const float per_height = static_cast<float>(image.width) / camera.aspect;
  const auto tiles_before = [](float middle, float offset, int most) {
    const float tile = std::floor((middle + offset - 2) / tile_size);
    return std::clamp(static_cast<int>(tile) * tile_size, 0, most);
  };
  const auto tiles_to = [](float middle, float offset, int most) {
    const float tile = std::ceil((middle + offset + 2) / tile_size);
    return std::clamp(static_cast<int>(tile) * tile_size, 0, most);
  };
  const float middle_x = static_cast<float>(image.width) / 2;
  const int left = tiles_before(middle_x, lower.x * per_height, image.width);
  const int top = tiles_before(height / 2, lower.y * height, image.height);
  return {left, top, tiles_to(middle_x, upper.x * per_height, image.width) - left,
          tiles_to(height / 2, upper.y * height, image.height) - top};
}

} // namespace octascope::ui
