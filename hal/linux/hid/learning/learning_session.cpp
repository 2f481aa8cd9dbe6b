#include "hal/linux/hid/learning/learning_session.h"

#include <cerrno>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/input.h>
#include <poll.h>
#include <unistd.h>

#include "hal/linux/hid/ports/control_port.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

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
  if (node.evdev)
    return open_input(node);
  auto device = RawDevice::open(node.node);
  if (!device)
    return tl::make_unexpected(device.error());
  const bool numbered = has_report_ids((*device)->report_descriptor());
  HAL_TRY(auto reader, ReportReader::start(**device));
  return File{.node = node,
              .learner = ControlLearner{numbered},
              .device = std::move(*device),
              .reader = std::move(reader)};
}

Result<LearningSession::File> LearningSession::open_input(const HidNode& node) {
  HAL_TRY(auto input, open_device(node.node, O_RDONLY | O_NONBLOCK));
  if (::ioctl(input.get(), EVIOCGRAB, 1) != 0)
    return system_failure(node.node, "taking it for octascope alone", errno);
  return File{.node = node, .learner = ControlLearner{false}, .input = std::move(input)};
}

Result<std::vector<std::string>> LearningSession::listen(Duration timeout) {
  std::vector<pollfd> waiting;
  for (const File& file : files_)
    waiting.push_back({file.reader ? file.reader->descriptor() : file.input.get(), POLLIN, 0});
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  ::poll(waiting.data(), waiting.size(), static_cast<int>(ms));
  std::vector<std::string> lines;
  for (File& file : files_)
    HAL_CHECK(file.reader ? read_reports(file, lines) : read_input(file, lines));
  return lines;
}

Result<> LearningSession::read_input(File& file, std::vector<std::string>& lines) {
  while (true) {
    input_event event{};
    const ssize_t size = ::read(file.input.get(), &event, sizeof event);
    if (size < 0 && (errno == EAGAIN || errno == EINTR))
      return {};
    if (size <= 0)
      return system_failure(file.node.node, "reading", size == 0 ? ENODEV : errno);
    const std::string change = file.learner.note(KeyEvent{event.type, event.code, event.value});
    if (!change.empty())
      lines.push_back(change);
  }
}

Result<> LearningSession::read_reports(File& file, std::vector<std::string>& lines) {
  while (true) {
    HAL_TRY(const auto report, file.reader->take());
    if (report.empty())
      return {};
    const std::string change = file.learner.note(report);
    if (!change.empty())
      lines.push_back(fmt::format("{:02x}   {}", fmt::join(report, " "), change));
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
