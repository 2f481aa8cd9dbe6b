#include "tests/virtual_hardware/support/scanout_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <memory>

#include <drm_fourcc.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "hal/linux/kms/drm/card_survey.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/linux/system/system_error.h"

namespace octascope::tests {

namespace {

using hal::ErrorCode;
using hal::linux_backend::FileDescriptor;
using hal::linux_backend::system_failure;

using Framebuffer = std::unique_ptr<drmModeFB2, decltype(&drmModeFreeFB2)>;

// The id of the frame buffer that an output scans; 0: none is on.
std::uint32_t scanned_framebuffer(const FileDescriptor& card) {
  const std::unique_ptr<drmModeRes, decltype(&drmModeFreeResources)> resources{
      drmModeGetResources(card.get()), drmModeFreeResources};
  for (int i = 0; resources && i < resources->count_crtcs; ++i) {
    const std::unique_ptr<drmModeCrtc, decltype(&drmModeFreeCrtc)> crtc{
        drmModeGetCrtc(card.get(), resources->crtcs[i]), drmModeFreeCrtc};
    if (crtc && crtc->mode_valid != 0 && crtc->buffer_id != 0)
      return crtc->buffer_id;
  }
  return 0;
}

// Where in a little-endian word the colours lie; nothing for other formats.
struct ColourPlaces {
  std::size_t red, green, blue;
};
const ColourPlaces* places_of(std::uint32_t format) {
  static constexpr ColourPlaces bgr{2, 1, 0};
  static constexpr ColourPlaces rgb{0, 1, 2};
  switch (format) {
  case DRM_FORMAT_XRGB8888:
  case DRM_FORMAT_ARGB8888: return &bgr;
  case DRM_FORMAT_XBGR8888:
  case DRM_FORMAT_ABGR8888: return &rgb;
  default: return nullptr;
  }
}

// A buffer that drmModeGetFB2 has made a handle for, mapped for reading.
class MappedBuffer {
public:
  MappedBuffer(const FileDescriptor& card, std::uint32_t handle, std::size_t size)
      : card_{card}, handle_{handle}, size_{size} {
    drm_mode_map_dumb map{};
    map.handle = handle;
    if (drmIoctl(card.get(), DRM_IOCTL_MODE_MAP_DUMB, &map) == 0)
      memory_ =
          ::mmap(nullptr, size, PROT_READ, MAP_SHARED, card.get(), static_cast<off_t>(map.offset));
    error_ = errno;
  }
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;
  ~MappedBuffer() {
    if (memory_ != MAP_FAILED)
      ::munmap(memory_, size_);
    drm_gem_close close{};
    close.handle = handle_;
    drmIoctl(card_.get(), DRM_IOCTL_GEM_CLOSE, &close);
  }

  const std::uint8_t* bytes() const {
    return memory_ != MAP_FAILED ? static_cast<const std::uint8_t*>(memory_) : nullptr;
  }
  int error() const { return error_; }

private:
  const FileDescriptor& card_;
  std::uint32_t handle_;
  std::size_t size_;
  void* memory_ = MAP_FAILED;
  int error_ = 0;
};

hal::Result<ScanoutPicture> read_framebuffer(const FileDescriptor& card, const std::string& node,
                                             std::uint32_t id) {
  const Framebuffer framebuffer{drmModeGetFB2(card.get(), id), drmModeFreeFB2};
  if (!framebuffer)
    return system_failure(node, "asking for what is on the screen", errno);
  if (framebuffer->handles[0] == 0)
    return hal::fail(ErrorCode::denied, node + ": what is on the screen is for root only");
  const std::size_t pitch = framebuffer->pitches[0];
  const std::size_t start = framebuffer->offsets[0];
  const MappedBuffer mapped{card, framebuffer->handles[0], start + pitch * framebuffer->height};
  const ColourPlaces* const places = places_of(framebuffer->pixel_format);
  const bool linear = (framebuffer->flags & DRM_MODE_FB_MODIFIERS) == 0 ||
                      framebuffer->modifier == DRM_FORMAT_MOD_LINEAR;
  if (places == nullptr || !linear)
    return hal::fail(ErrorCode::unsupported,
                     fmt::format("{}: format 0x{:08x} with modifier 0x{:x} on the screen, expected "
                                 "8 bits a colour in plain rows",
                                 node, framebuffer->pixel_format, framebuffer->modifier));
  if (mapped.bytes() == nullptr)
    return system_failure(node, "mapping what is on the screen", mapped.error());

  ScanoutPicture picture;
  picture.width = static_cast<int>(framebuffer->width);
  picture.height = static_cast<int>(framebuffer->height);
  picture.rgb.reserve(std::size_t{3} * framebuffer->width * framebuffer->height);
  for (std::size_t y = 0; y < framebuffer->height; ++y)
    for (std::size_t x = 0; x < framebuffer->width; ++x) {
      const std::uint8_t* const word = mapped.bytes() + start + y * pitch + 4 * x;
      for (const std::size_t place : {places->red, places->green, places->blue})
        picture.rgb.push_back(word[place]);
    }
  return picture;
}

} // namespace

hal::Result<ScanoutPicture> read_scanout(const std::string& card) {
  const auto nodes =
      card.empty() ? hal::linux_backend::kms::card_nodes() : std::vector<std::string>{card};
  for (const std::string& node : nodes) {
    HAL_TRY(auto file, hal::linux_backend::open_device(node, O_RDWR));
    drmDropMaster(file.get()); // whoever opens a card that nobody has is its master: we only look
    if (const std::uint32_t id = scanned_framebuffer(file))
      return read_framebuffer(file, node, id);
  }
  return hal::fail(ErrorCode::absent, "no output is on, expected a program that shows a picture");
}

int largest_difference(const ScanoutPicture& a, const ScanoutPicture& b) {
  if (a.width != b.width || a.height != b.height)
    return 256;
  int largest = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    largest = std::max(largest, std::abs(int{a.rgb[i]} - int{b.rgb[i]}));
  return largest;
}

} // namespace octascope::tests
