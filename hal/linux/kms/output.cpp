#include "hal/linux/kms/output.h"

#include <array>
#include <cerrno>
#include <span>

#include <drm_mode.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "hal/linux/kms/drm/object_properties.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend::kms {

namespace {

// A flip takes a refresh; virtual outputs were seen to take a fifth of a second. Beyond this an
// output does not answer.
constexpr std::chrono::seconds patience{2};
// How long a wait may overlook that the monitor or the seat has gone.
constexpr int slice_ms = 100;
constexpr int busy_slice_ms = 1;

bool is_not_ours(int error) {
  return error == EACCES || error == EPERM;
}

bool readable(const FileDescriptor& file, int timeout_ms) {
  pollfd waiting{file.get(), POLLIN, 0};
  return ::poll(&waiting, 1, timeout_ms) > 0;
}

std::unique_ptr<Scanout> make_scanout(bool atomic, ScanoutTarget target) {
  return atomic ? make_atomic_scanout(std::move(target)) : make_legacy_scanout(std::move(target));
}

} // namespace

Output::Output(Clock& clock, Seat& seat, const SeatDevice& device, const Card& card,
               const OutputChoice& choice)
    : clock_{clock}, seat_{seat}, file_{device.file}, card_{card},
      connector_{card.connectors[choice.connector]}, mode_{choice.mode}, name_{fmt::format(
                                                                             "{} {}", card.node,
                                                                             connector_.name)},
      scanout_{make_scanout(choice.atomic,
                            {file_, card_, connector_, choice.crtc, choice.plane, choice.mode})},
      before_{file_, card_, choice.crtc}, watch_{card_, connector_} {}

Output::~Output() {
  before_.restore(file_);
}

Result<> Output::check() {
  if (watch_.disconnected())
    return fail(ErrorCode::disconnected,
                "{}: the monitor is gone, expected it to stay plugged in and switched on; check "
                "its cable and power; it is tried again by itself",
                name_);
  if (watch_.changed() && link_is_bad())
    want_mode();
  return {};
}

bool Output::link_is_bad() const {
  const ObjectProperties now{file_, connector_.id, DRM_MODE_OBJECT_CONNECTOR};
  return now.value("link-status") == DRM_MODE_LINK_STATUS_BAD;
}

Result<std::optional<FlipTimes>> Output::show(const DrawnPicture& picture) {
  if (mode_wanted_)
    return set_mode(picture);
  FlipTimes times;
  times.submitted = clock_.now();
  const int error = submit(picture);
  if (error == 0)
    return wait_for_flip(times);
  if (is_not_ours(error))
    return std::nullopt;
  // Somebody else has changed the output while it was theirs.
  if (error == EINVAL || error == ENOENT)
    return set_mode(picture);
  if (error == EBUSY)
    return fail(ErrorCode::timed_out,
                "{}: the flip before is not done after {} s; the output is opened again", name_,
                patience.count());
  return system_failure(name_, "showing a picture", error, "the output is opened again");
}

Result<std::optional<FlipTimes>> Output::set_mode(const DrawnPicture& picture) {
  FlipTimes times;
  times.submitted = clock_.now();
  const int error = scanout_->set_mode(picture.framebuffer);
  if (is_not_ours(error))
    return std::nullopt;
  if (error != 0)
    return system_failure(name_, fmt::format("setting the mode {}", to_text(mode_)), error,
                          "configure another mode of the monitor's (octascope devices lists them)");
  mode_wanted_ = false;
  times.mode_set = true;
  times.received = clock_.now();
  return times;
}

// EBUSY passes when the flip before is done: its event says so.
int Output::submit(const DrawnPicture& picture) {
  const TimePoint deadline = clock_.now() + patience;
  ++number_;
  int error = scanout_->flip(picture.framebuffer, picture.fence.get(), number_);
  while (error == EBUSY && clock_.now() < deadline) {
    if (readable(file_, busy_slice_ms) && !read_flip())
      ::poll(nullptr, 0, busy_slice_ms); // readable for ever, as a card that is gone is
    error = scanout_->flip(picture.framebuffer, picture.fence.get(), number_);
  }
  return error;
}

// Of all that can be read now, the newest flip's event. Older ones are of flips given up on.
std::optional<FlipEvent> Output::read_flip() {
  std::array<std::byte, 1024> buffer;
  const ssize_t length = ::read(file_.get(), buffer.data(), buffer.size());
  std::span<const std::byte> bytes{buffer.data(),
                                   length > 0 ? static_cast<std::size_t>(length) : 0};
  std::optional<FlipEvent> newest;
  while (const auto event = take_flip(bytes))
    if (!newest || event->number >= newest->number)
      newest = event;
  return newest;
}

Result<std::optional<FlipTimes>> Output::wait_for_flip(FlipTimes times) {
  while (clock_.now() - times.submitted < patience) {
    if (readable(file_, slice_ms)) {
      const auto event = read_flip();
      if (event && event->number == number_) {
        times.received = clock_.now();
        if (card_.monotonic)
          times.stamp = event->stamp;
        return times;
      }
      if (event)
        continue;
      ::poll(nullptr, 0, busy_slice_ms);
    }
    if (!seat_.active())
      return std::nullopt;
    HAL_CHECK(check());
  }
  return fail(ErrorCode::timed_out,
              "{}: a picture was not shown within {} s; the output is opened again", name_,
              patience.count());
}

} // namespace octascope::hal::linux_backend::kms
