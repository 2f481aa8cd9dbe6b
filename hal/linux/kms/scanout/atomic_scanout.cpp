#include <cerrno>

#include "hal/linux/kms/drm/drm_resource.h"
#include "hal/linux/kms/drm/object_properties.h"
#include "hal/linux/kms/scanout/atomic_request.h"
#include "hal/linux/kms/scanout/scanout.h"

namespace octascope::hal::linux_backend::kms {

namespace {

// The mode's timings as the kernel's own object, for as long as a commit names it.
class ModeBlob {
public:
  ModeBlob(const FileDescriptor& file, const Mode& mode) : file_{file} {
    drmModeModeInfo info = to_kernel(mode);
    error_ = drmModeCreatePropertyBlob(file.get(), &info, sizeof info, &id_) == 0 ? 0 : errno;
  }
  ModeBlob(const ModeBlob&) = delete;
  ModeBlob& operator=(const ModeBlob&) = delete;
  ~ModeBlob() {
    if (error_ == 0)
      drmModeDestroyPropertyBlob(file_.get(), id_);
  }

  int error() const { return error_; }
  std::uint32_t id() const { return id_; }

private:
  const FileDescriptor& file_;
  std::uint32_t id_ = 0;
  int error_ = 0;
};

class AtomicScanout final : public Scanout {
public:
  explicit AtomicScanout(ScanoutTarget target)
      : target_{std::move(target)}, plane_{target_.file, target_.plane, DRM_MODE_OBJECT_PLANE},
        crtc_{target_.file, target_.crtc, DRM_MODE_OBJECT_CRTC},
        connector_{target_.file, target_.connector.id, DRM_MODE_OBJECT_CONNECTOR},
        framebuffer_property_{plane_.id("FB_ID")}, fence_property_{plane_.id("IN_FENCE_FD")} {}

  int set_mode(std::uint32_t framebuffer) override {
    const ModeBlob mode{target_.file, target_.mode};
    if (mode.error() != 0)
      return mode.error();
    AtomicRequest request;
    detach_others(request);
    request.object(target_.connector.id);
    request.set(connector_.id("CRTC_ID"), target_.crtc);
    request.set(connector_.id("link-status"), DRM_MODE_LINK_STATUS_GOOD);
    request.object(target_.crtc);
    request.set(crtc_.id("MODE_ID"), mode.id());
    request.set(crtc_.id("ACTIVE"), 1);
    request.set(crtc_.id("VRR_ENABLED"), 0);
    for (const char* const table : {"GAMMA_LUT", "DEGAMMA_LUT", "CTM"})
      request.set(crtc_.id(table), 0); // no table: the identity
    show(request, framebuffer);
    return request.commit(target_.file, DRM_MODE_ATOMIC_ALLOW_MODESET, 0);
  }

  int flip(std::uint32_t framebuffer, int fence, std::uint64_t number) override {
    flip_.clear();
    flip_.object(target_.plane);
    flip_.set(framebuffer_property_, framebuffer);
    if (fence >= 0)
      flip_.set(fence_property_, static_cast<std::uint64_t>(fence));
    return flip_.commit(target_.file, DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT, number);
  }

  bool takes_fences() const override { return fence_property_ != 0; }

private:
  // The whole frame buffer on the whole picture. Source positions are in 1/65536 of a pixel.
  void show(AtomicRequest& request, std::uint32_t framebuffer) const {
    const std::uint64_t width = target_.mode.width;
    const std::uint64_t height = target_.mode.height;
    request.object(target_.plane);
    request.set(framebuffer_property_, framebuffer);
    request.set(plane_.id("CRTC_ID"), target_.crtc);
    request.set(plane_.id("SRC_X"), 0);
    request.set(plane_.id("SRC_Y"), 0);
    request.set(plane_.id("SRC_W"), width << 16);
    request.set(plane_.id("SRC_H"), height << 16);
    request.set(plane_.id("CRTC_X"), 0);
    request.set(plane_.id("CRTC_Y"), 0);
    request.set(plane_.id("CRTC_W"), width);
    request.set(plane_.id("CRTC_H"), height);
    request.set(plane_.id("rotation"), DRM_MODE_ROTATE_0);
    request.set(plane_.id("alpha"), 0xffff);
  }

  // Asked anew each time: whoever had the card while we had not may have left something on it.
  void detach_others(AtomicRequest& request) const {
    for (const Connector& other : target_.card.connectors) {
      const ObjectProperties properties{target_.file, other.id, DRM_MODE_OBJECT_CONNECTOR};
      if (other.id == target_.connector.id || properties.value("CRTC_ID") != target_.crtc)
        continue;
      request.object(other.id);
      request.set(properties.id("CRTC_ID"), 0);
    }
    for (const Plane& other : target_.card.planes) {
      const ObjectProperties properties{target_.file, other.id, DRM_MODE_OBJECT_PLANE};
      if (other.id == target_.plane || properties.value("CRTC_ID") != target_.crtc)
        continue;
      request.object(other.id);
      request.set(properties.id("FB_ID"), 0);
      request.set(properties.id("CRTC_ID"), 0);
    }
  }

  const ScanoutTarget target_;
  const ObjectProperties plane_;
  const ObjectProperties crtc_;
  const ObjectProperties connector_;
  const std::uint32_t framebuffer_property_;
  const std::uint32_t fence_property_;
  AtomicRequest flip_;
};

} // namespace

std::unique_ptr<Scanout> make_atomic_scanout(ScanoutTarget target) {
  return std::make_unique<AtomicScanout>(std::move(target));
}

} // namespace octascope::hal::linux_backend::kms
