// What VolumePainter has of flow: its texture, its programs, and which volume's it is.
#include <utility>

#include "ui/scene/volume_painter.h"
#include "ui/transfer/flow_look.h"

namespace octascope::ui {

// The processor casts rays through its own copy; GL draws all else, a cut's faces included.
bool VolumePainter::needs_flow_texture(const ViewState& view, RayBackend rays) const {
  return draws_flow(view) && (parts_for(view, rays).all || view.cut != CutShape::none);
}

hal::Result<> VolumePainter::bring_flow_texture(const pipeline::Volume& volume,
                                                const TextureParts& parts) {
  if (flow_uploads_ == uploads_) {
    if (flow_texture_.holds(parts))
      return {};
    flow_before_ = 0;
    flow_whole_ = parts.all;
    return flow_texture_.renew(volume, {}, parts);
  }
  const bool renewed = flow_uploads_ + 1 == uploads_ && !changed_.empty();
  const bool whole_before = flow_whole_ && parts.all && flow_texture_.geometry() == volume.geometry;
  flow_before_ = whole_before ? flow_uploads_ : 0;
  flow_whole_ = parts.all;
  HAL_CHECK(renewed ? flow_texture_.renew(volume, changed_, parts)
                    : flow_texture_.upload(volume, parts));
  flow_uploads_ = uploads_;
  return {};
}

hal::Result<> VolumePainter::make_flow_programs(Technique technique, bool by_gl) {
  if (!flow_cut_face_) {
    HAL_TRY(auto made, CutFace::create(WithFlow::yes));
    flow_cut_face_.emplace(std::move(made));
  }
  if (by_gl)
    HAL_CHECK(techniques_.get(technique, WithFlow::yes));
  return {};
}

void VolumePainter::refuse_flow(hal::Error why) {
  flow_refusal_ = std::move(why);
  flow_wanted_ = false;
}

// To the volume that the mesh is of. False: that is not there any more, which is said for a second at the
// most usual rate.
bool VolumePainter::match_flow(FlowScene& flow) {
  constexpr std::uint64_t late_for_volumes = 4;
  const std::uint64_t of = techniques_.surface()->mesh_of();
  flow.before = of == flow_before_;
  const bool there = of != 0 && (of == flow_uploads_ || flow.before);
  if (!there)
    flow_late_until_ = uploads_ + late_for_volumes;
  return there;
}

FlowScene VolumePainter::flow_scene(float view_opacity) const {
  return {flow_texture_, flow_marks_, flow_opacity(view_opacity)};
}

} // namespace octascope::ui
