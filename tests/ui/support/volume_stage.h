// One volume, drawn by any technique, by GL or by the processor, and read back as numbers.
#pragma once

#include <memory>
#include <vector>

#include "pipeline/volume/volume.h"
#include "ui/ray_caster/ray_caster.h"
#include "ui/volume/volume_picture.h"

namespace octascope::tests {

struct StagePicture {
  int width = 0;
  int height = 0;
  struct Pixel {
    float red = 0; // premultiplied, 0…1
    float green = 0;
    float blue = 0;
    float opacity = 0;
    bool operator==(const Pixel&) const = default;
  };
  std::vector<Pixel> pixels;   // rows from the top
  std::vector<float> depth_mm; // empty where nothing draws depth

  const Pixel& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

// Over all pixels and channels, in counts of 255.
double mean_difference(const StagePicture& a, const StagePicture& b);
// Of opacity, in counts of 255.
double mean_opacity(const StagePicture& picture);

struct StageSettings {
  int width = 160;
  int height = 100;
  float step_mm = 0.01F;
  bool leap_empty = true;
  bool as_table = false; // a window is looked up instead of computed
  bool flow = false;     // of a volume that has it
};

// Needs a current context.
class VolumeStage {
public:
  VolumeStage();

  void show(const pipeline::Volume& volume);
  StagePicture draw(const ui::ViewState& view, const StageSettings& settings);
  // The same with that transfer function instead of the view's window.
  StagePicture draw(const ui::ViewState& view, const ui::TransferTable& table,
                    const StageSettings& settings);
  // By the processor.
  StagePicture cast(const ui::ViewState& view, ui::RayMode mode, const StageSettings& settings);
  StagePicture cast(const ui::ViewState& view, const ui::TransferTable& table, ui::RayMode mode,
                    const StageSettings& settings);

private:
  StagePicture read() const;
  const ui::LightVolume* light_for(const ui::ViewState& view);
  ui::Camera camera(const ui::ViewState& view, const StageSettings& settings) const;

  ui::VolumeTexture texture_;
  ui::VolumeTexture flow_texture_{ui::Voxels::flow};
  pipeline::FlowMarks flow_marks_;
  pipeline::Occupancy occupancy_;
  ui::TransferTexture transfer_;
  std::unique_ptr<ui::TransferTable> table_;
  ui::VolumeTechniques techniques_{ui::TransferSet{}};
  ui::VolumePicture picture_;
  ui::RayCaster caster_;
  ui::LightVolume light_;
  std::uint64_t uploads_ = 0;
};

} // namespace octascope::tests
