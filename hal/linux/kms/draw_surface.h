// Where EGL draws and KMS reads: a GBM surface with its EGL context, and its buffers as frame
// buffers of the card.
#pragma once

#include <cstdint>
#include <memory>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/system/file_descriptor.h"

struct gbm_bo;

namespace octascope::hal::linux_backend::kms {

// A picture that is drawn and may be shown.
struct DrawnPicture {
  gbm_bo* buffer = nullptr;
  std::uint32_t framebuffer = 0;
  FileDescriptor fence; // signalled when the drawing is done; none: the kernel knows by itself
};

struct DrawSurfaceSetup {
  int width = 0;
  int height = 0;
  const Card& card;
  const Plane* plane = nullptr; // null: nothing is known of it
  bool modifiers = true;        // let the driver choose a layout from those that the plane can show
};

// Threads: bound to the one that makes it, where its context is current.
class DrawSurface {
public:
  // ErrorCode::unsupported: no EGL for this card, or no format that both can.
  static Result<std::unique_ptr<DrawSurface>> create(const FileDescriptor& card,
                                                     const DrawSurfaceSetup& setup);
  DrawSurface(const DrawSurface&) = delete;
  DrawSurface& operator=(const DrawSurface&) = delete;
  ~DrawSurface();

  // Was a layout chosen that needs a modifier to be named?
  bool uses_modifiers() const;

  // What was drawn since the last time, with a fence if asked for and the driver can. The buffer is
  // the caller's until release().
  Result<DrawnPicture> take_picture(bool with_fence);
  void release(gbm_bo* buffer);

private:
  struct Parts;
  explicit DrawSurface(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::hal::linux_backend::kms
