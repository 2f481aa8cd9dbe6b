// A GBM surface into which EGL draws, its EGL context, and its buffers as frame buffers that KMS
// can show.
#pragma once

#include <cstdint>
#include <memory>

#include "hal/display.h"
#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/system/file_descriptor.h"

struct gbm_bo;

namespace octascope::hal::linux_backend::kms {

// A drawn image that can be shown.
struct DrawnPicture {
  gbm_bo* buffer = nullptr;
  std::uint32_t framebuffer = 0;
  FileDescriptor fence; // signalled when the drawing is done; none: the kernel tracks it
};

struct DrawSurfaceSetup {
  int width = 0;
  int height = 0;
  const Card& card;
  const Plane* plane = nullptr; // null: unknown
  bool modifiers = true;        // let the driver choose among the layouts that the plane can show
};

// Threads: bound to the thread that creates it, where its context is current.
class DrawSurface {
public:
  // ErrorCode::unsupported: no EGL for this card, or no format that both support.
  static Result<std::unique_ptr<DrawSurface>> create(const FileDescriptor& card,
                                                     const DrawSurfaceSetup& setup);
  DrawSurface(const DrawSurface&) = delete;
  DrawSurface& operator=(const DrawSurface&) = delete;
  ~DrawSurface();

  // Whether the buffers' layout is given by a modifier.
  bool uses_modifiers() const;

  // What the buffer to draw into holds; images are counted by take_picture().
  BackBuffer back_buffer() const;

  // Ends the image that was being drawn and returns it, with a fence if requested and supported.
  // The buffer belongs to the caller until release().
  Result<DrawnPicture> take_picture(bool with_fence);
  void release(gbm_bo* buffer);

private:
  struct Parts;
  explicit DrawSurface(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::hal::linux_backend::kms
