#include "hal/linux/hid/learning/learning_session.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/hidraw.h>
#include <linux/input.h>
#include <poll.h>
#include <unistd.h>

#include "hal/linux/hid/ports/control_port.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

bool numbers_its_reports(const FileDescriptor& hidraw) {
  int size = 0;
  hidraw_report_descriptor descriptor{};
  if (control(hidraw, HIDIOCGRDESCSIZE, &size) != 0)
    return false;
  descriptor.size = static_cast<std::uint32_t>(size);
  return control(hidraw, HIDIOCGRDESC, &descriptor) == 0 &&
         has_report_ids(std::span{descriptor.value}.first(descriptor.size));
}

} // namespace

Result<LearningSession> LearningSession::listen_to(std::vector<HidNode> nodes) {
  LearningSession session;
  std::optional<Error> refused;
  for (const HidNode& node : nodes) {
    if (auto file = open(node))
      session.files_.push_back(std::move(*file));
    else
      refused = file.error();
  }
  if (!session.files_.empty())
    return session;
  if (refused)
    return fail(refused->code, refused->message + remedy_of_control("it", refused->code));
  return fail(ErrorCode::absent,
              "learning: found no HID device, expected the one that is to be learned; "
              "plug it in, or name it with --device VENDOR:PRODUCT");
}

Result<LearningSession::File> LearningSession::open(const HidNode& node) {
  HAL_TRY(auto file, open_device(node.node, O_RDONLY | O_NONBLOCK));
  if (node.evdev && ::ioctl(file.get(), EVIOCGRAB, 1) != 0)
    return system_failure(node.node, "taking it for octascope alone", errno);
  const bool numbered = !node.evdev && numbers_its_reports(file);
  return File{std::move(file), node, ControlLearner{numbered}};
}

Result<std::vector<std::string>> LearningSession::listen(Duration timeout) {
  std::vector<pollfd> waiting;
  for (const File& file : files_)
    waiting.push_back({file.descriptor.get(), POLLIN, 0});
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  ::poll(waiting.data(), waiting.size(), static_cast<int>(ms));
  std::vector<std::string> lines;
  for (File& file : files_)
    HAL_CHECK(read(file, lines));
  return lines;
}

Result<> LearningSession::read(File& file, std::vector<std::string>& lines) {
  std::array<std::uint8_t, 256> bytes{};
  while (true) {
    input_event event{};
    const ssize_t size = file.node.evdev
                             ? ::read(file.descriptor.get(), &event, sizeof event)
                             : ::read(file.descriptor.get(), bytes.data(), bytes.size());
    if (size < 0 && (errno == EAGAIN || errno == EINTR))
      return {};
    if (size <= 0)
      return system_failure(file.node.node, "reading", size == 0 ? ENODEV : errno);
    const auto report = std::span{bytes}.first(static_cast<std::size_t>(size));
    const std::string change =
        file.node.evdev ? file.learner.note(KeyEvent{event.type, event.code, event.value})
                        : file.learner.note(report);
    if (change.empty())
      continue;
    lines.push_back(file.node.evdev ? change
                                    : fmt::format("{:02x}   {}", fmt::join(report, " "), change));
  }
}

// A control that types is known by its keys: its reports have the keys' numbers, not switches.
std::optional<ControlModel> LearningSession::learned() const {
  std::optional<ControlModel> best;
  for (const File& file : files_) {
    auto model = file.learner.model(file.node.vendor, file.node.product, file.node.name);
    if (model && (!best || model->by_evdev() || model->switches > best->switches))
      best = std::move(model);
  }
  return best;
}

} // namespace octascope::hal::linux_backend
