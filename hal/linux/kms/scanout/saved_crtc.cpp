#include "hal/linux/kms/drm/drm_resource.h"
#include "hal/linux/kms/scanout/scanout.h"

namespace octascope::hal::linux_backend::kms {

SavedCrtc::SavedCrtc(const FileDescriptor& file, const Card& card, std::uint32_t crtc)
    : crtc_{crtc} {
  for (const Connector& connector : card.connectors)
    if (connector.current_crtc == crtc)
      connectors_.push_back(connector.id);
  const DrmCrtc before{drmModeGetCrtc(file.get(), crtc)};
  if (!before || before->mode_valid == 0)
    return;
  framebuffer_ = before->buffer_id;
  x_ = before->x;
  y_ = before->y;
  mode_ = from_kernel(before->mode);
}

void SavedCrtc::restore(const FileDescriptor& file) {
  if (crtc_ == 0)
    return;
  if (mode_ && framebuffer_ != 0 && !connectors_.empty()) {
    drmModeModeInfo mode = to_kernel(*mode_);
    if (drmModeSetCrtc(file.get(), crtc_, framebuffer_, x_, y_, connectors_.data(),
                       static_cast<int>(connectors_.size()), &mode) == 0)
      return;
  }
  drmModeSetCrtc(file.get(), crtc_, 0, 0, 0, nullptr, 0, nullptr);
}

} // namespace octascope::hal::linux_backend::kms
