// Ray casting in a fragment shader: the counterpart of ui/ray_caster/ray_caster.h, with the same
// samples, constants and modes, so that both draw the same picture.
#pragma once

#include <cstdint>
#include <optional>

#include "ui/bricks/brick_distances.h"
#include "ui/bricks/brick_grid.h"
#include "ui/gl/objects.h"
#include "ui/ray_caster/ray_caster.h"
#include "ui/volume/transfer_program.h"
#include "ui/volume/volume_technique.h"

namespace octascope::ui {

// Writes depth. Skips the bricks that occupancy and transfer function make empty; this changes only
// the drawing time, not the picture.
//
// Threads: as gl/objects.h. draw() allocates when the volume's geometry changes.
class RayCastTechnique : public VolumeTechnique {
public:
  static hal::Result<RayCastTechnique> create(RayMode mode, WithFlow flow = WithFlow::no);

private:
  RayCastTechnique(RayMode mode, TransferProgram program);
  void do_draw(const VolumeScene& scene) override;
  bool do_writes_depth() const override { return true; }
  bool do_dithers() const override { return true; }
  void prepare_bricks(const VolumeScene& scene);
  void set_rays(const gl::Program& program, const VolumeScene& scene) const;
  void set_light(const gl::Program& program, const VolumeScene& scene);
  void upload_light(const LightVolume& light);

  RayMode mode_;
  TransferProgram program_;
  gl::VertexArray vertex_array_; // empty: vertices are computed from their index
  BrickGrid bricks_;
  BrickGrid flow_bricks_;
  DistancesAround distances_;
  gl::Texture brick_texture_;
  pipeline::BrickCounts brick_counts_;
  gl::Texture light_texture_;
  LightVolume::Counts light_counts_;
  std::uint64_t light_version_ = 0;
  // The inputs of the bricks.
  struct BrickSource {
    std::uint64_t upload;
    std::uint64_t transfer;
    bool operator==(const BrickSource&) const = default;
  };
  std::optional<BrickSource> brick_source_;
};

} // namespace octascope::ui
