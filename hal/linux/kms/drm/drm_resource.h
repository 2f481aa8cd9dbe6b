// Owning pointers to libdrm's objects. Internal to hal/linux/kms.
#pragma once

#include <memory>

#include <xf86drm.h>
#include <xf86drmMode.h>

#include "hal/linux/kms/drm/topology.h"

namespace octascope::hal::linux_backend::kms {

template <auto Free> struct DrmFree {
  template <class Object> void operator()(Object* object) const { Free(object); }
};
template <class Object, auto Free> using DrmPointer = std::unique_ptr<Object, DrmFree<Free>>;

using DrmVersion = DrmPointer<drmVersion, drmFreeVersion>;
using DrmResources = DrmPointer<drmModeRes, drmModeFreeResources>;
using DrmConnector = DrmPointer<drmModeConnector, drmModeFreeConnector>;
using DrmEncoder = DrmPointer<drmModeEncoder, drmModeFreeEncoder>;
using DrmCrtc = DrmPointer<drmModeCrtc, drmModeFreeCrtc>;
using DrmPlaneResources = DrmPointer<drmModePlaneRes, drmModeFreePlaneResources>;
using DrmPlane = DrmPointer<drmModePlane, drmModeFreePlane>;
using DrmObjectProperties = DrmPointer<drmModeObjectProperties, drmModeFreeObjectProperties>;
using DrmProperty = DrmPointer<drmModePropertyRes, drmModeFreeProperty>;
using DrmBlob = DrmPointer<drmModePropertyBlobRes, drmModeFreePropertyBlob>;

Mode from_kernel(const drmModeModeInfo& mode);
drmModeModeInfo to_kernel(const Mode& mode);

} // namespace octascope::hal::linux_backend::kms
