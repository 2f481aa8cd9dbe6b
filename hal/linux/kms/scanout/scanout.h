// Modes and flips on one output: by atomic commits, or by the older calls where the driver has no
// atomic ones.
#pragma once

#include <cstdint>
#include <memory>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

// What is shown where. The card's file and description outlive the Scanout.
struct ScanoutTarget {
  const FileDescriptor& file;
  const Card& card;
  const Connector& connector;
  std::uint32_t crtc = 0;
  std::uint32_t plane = 0;
  Mode mode;
};

// Every call returns 0 or an errno. Threads: one at a time.
class Scanout {
public:
  Scanout() = default;
  Scanout(const Scanout&) = delete;
  Scanout& operator=(const Scanout&) = delete;
  virtual ~Scanout() = default;

  // Sets the mode and shows `framebuffer` (of the mode's size) alone: no cursor, no other plane, no
  // other connector, colours unchanged on their way. Returns when it is shown.
  virtual int set_mode(std::uint32_t framebuffer) = 0;

  // Shows `framebuffer` from the next refresh on and returns at once; the card's file then says so
  // with an event that carries `number`. EBUSY: the flip before is not done yet. `fence`: shown not
  // before it is signalled; −1 for none.
  virtual int flip(std::uint32_t framebuffer, int fence, std::uint64_t number) = 0;

  virtual bool takes_fences() const { return false; }
};

std::unique_ptr<Scanout> make_atomic_scanout(ScanoutTarget target);
std::unique_ptr<Scanout> make_legacy_scanout(ScanoutTarget target);

// What a CRTC showed before us, so that the console comes back.
class SavedCrtc {
public:
  SavedCrtc() = default;
  SavedCrtc(const FileDescriptor& file, const Card& card, std::uint32_t crtc);
  // As it was; where that cannot be, the output is off.
  void restore(const FileDescriptor& file);

private:
  std::uint32_t crtc_ = 0;
  std::uint32_t framebuffer_ = 0;
  std::uint32_t x_ = 0;
  std::uint32_t y_ = 0;
  std::optional<Mode> mode_;
  std::vector<std::uint32_t> connectors_;
};

} // namespace octascope::hal::linux_backend::kms
