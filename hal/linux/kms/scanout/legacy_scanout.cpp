#include <algorithm>
#include <cstddef>
#include <vector>

#include "hal/linux/kms/drm/drm_resource.h"
#include "hal/linux/kms/scanout/scanout.h"

namespace octascope::hal::linux_backend::kms {

namespace {

// libdrm says "-errno".
int error_of(int result) {
  return std::max(-result, 0);
}

class LegacyScanout final : public Scanout {
public:
  explicit LegacyScanout(ScanoutTarget target) : target_{std::move(target)} {}

  int set_mode(std::uint32_t framebuffer) override {
    const int file = target_.file.get();
    drmModeModeInfo mode = to_kernel(target_.mode);
    std::uint32_t connector = target_.connector.id;
    const int set = drmModeSetCrtc(file, target_.crtc, framebuffer, 0, 0, &connector, 1, &mode);
    if (set != 0)
      return error_of(set);
    // Refused where there is nothing of the kind: then nothing is in the picture's way either.
    drmModeSetCursor(file, target_.crtc, 0, 0, 0);
    hide_other_planes();
    reset_gamma();
    return 0;
  }

  int flip(std::uint32_t framebuffer, int, std::uint64_t number) override {
    // The kernel hands the value back as it is and follows no pointer.
    void* const data = reinterpret_cast<void*>(static_cast<std::uintptr_t>(number));
    return error_of(drmModePageFlip(target_.file.get(), target_.crtc, framebuffer,
                                    DRM_MODE_PAGE_FLIP_EVENT, data));
  }

private:
  void hide_other_planes() const {
    for (const Plane& other : target_.card.planes) {
      // One that is not known for sure may be what the picture is on.
      if (other.kind != PlaneKind::overlay && other.kind != PlaneKind::cursor)
        continue;
      const DrmPlane now{drmModeGetPlane(target_.file.get(), other.id)};
      if (now && now->crtc_id == target_.crtc)
        drmModeSetPlane(target_.file.get(), other.id, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
    }
  }

  void reset_gamma() const {
    const DrmCrtc crtc{drmModeGetCrtc(target_.file.get(), target_.crtc)};
    if (!crtc || crtc->gamma_size < 2)
      return;
    const auto size = static_cast<std::size_t>(crtc->gamma_size);
    std::vector<std::uint16_t> identity(size);
    for (std::size_t i = 0; i < size; ++i)
      identity[i] = static_cast<std::uint16_t>(i * 0xffff / (size - 1));
    drmModeCrtcSetGamma(target_.file.get(), target_.crtc, static_cast<std::uint32_t>(size),
                        identity.data(), identity.data(), identity.data());
  }

  const ScanoutTarget target_;
};

} // namespace

std::unique_ptr<Scanout> make_legacy_scanout(ScanoutTarget target) {
  return std::make_unique<LegacyScanout>(std::move(target));
}

} // namespace octascope::hal::linux_backend::kms
