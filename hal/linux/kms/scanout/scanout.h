// Sets modes and flips on one output: with atomic commits, or with the legacy calls if the driver
// does not support them.
#pragma once

#include <cstdint>
#include <memory>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

// The output and its mode. All references must outlive the Scanout.
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

  // Sets the mode and shows only `framebuffer` (of the mode's size): no cursor, no other plane or
  // connector, no colour conversion. Returns when it is visible.
  virtual int set_mode(std::uint32_t framebuffer) = 0;

  // Shows `framebuffer` from the next refresh on, but not before `fence` (−1: none) is signalled.
  // Returns immediately; when it is visible, the card sends an event with `number`. EBUSY: the
  // previous flip is still pending.
  virtual int flip(std::uint32_t framebuffer, int fence, std::uint64_t number) = 0;

  virtual bool takes_fences() const { return false; }
};

std::unique_ptr<Scanout> make_atomic_scanout(ScanoutTarget target);
std::unique_ptr<Scanout> make_legacy_scanout(ScanoutTarget target);

// What a CRTC showed before, in order to restore the console.
class SavedCrtc {
public:
  SavedCrtc() = default;
  SavedCrtc(const FileDescriptor& file, const Card& card, std::uint32_t crtc);
  // Restores it; if that fails, turns the output off.
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
