#include "ui/vessels/hybrid/hybrid_method.h"

#include <GLES3/gl3.h>

namespace octascope::ui {

hal::Result<HybridMethod> HybridMethod::create(std::size_t helpers,
                                               const pipeline::ThreadSetup& setup, Share share) {
  HAL_TRY(auto splatter, Splatter::create(helpers, setup));
  HAL_TRY(auto picture, SplatPicture::create());
  return HybridMethod{std::move(splatter), std::move(picture), std::move(share)};
}

hal::Result<SegmentCounts> HybridMethod::do_draw(const VesselScene& scene) {
  SegmentCounts account;
  if (share_.gl) {
    split_by_radius(scene, share_.gl_radius_px, split_);
    HAL_TRY(const auto by_gl, share_.gl->draw(scene, split_));
    account = by_gl;
    glFlush(); // GL begins now, beside the splatter
  }
  HAL_TRY(const auto by_processor, splatter_.draw(scene, image_, {split_, detail_px_}));
  account.splatted += by_processor.splatted;
  account.merged += by_processor.merged;
  account.culled += by_processor.culled;
  if (share_.gl) { // else nothing lies below
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
  const auto drawn = picture_.draw(image_, scene.camera, splatter_.columns());
  glDisable(GL_BLEND);
  HAL_CHECK(drawn);
  return account;
}

} // namespace octascope::ui
