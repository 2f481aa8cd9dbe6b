// libgpiod 1.4 … 1.6, as in Debian 12.
#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>

#include <gpiod.h>
#include <poll.h>

#include "hal/linux/gpio/gpio_line.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

struct ChipCloser {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, ChipCloser>;

Result<Chip> open_chip(const std::string& node) {
  Chip chip{gpiod_chip_open(node.c_str())};
  if (!chip)
    return system_failure(node, "opening", errno == ENODEV || errno == ENOTTY ? ENOENT : errno);
  return chip;
}

std::string text(const char* maybe) {
  return maybe != nullptr ? maybe : "";
}

} // namespace

struct GpioLine::Handle {
  Chip chip;
  gpiod_line* line = nullptr; // the chip's

  explicit Handle(Chip of) : chip{std::move(of)} {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (line != nullptr && gpiod_line_is_requested(line))
      gpiod_line_release(line);
  }

  static Result<std::unique_ptr<Handle>> find(const std::string& node, unsigned offset) {
    HAL_TRY(auto chip, open_chip(node));
    auto handle = std::make_unique<Handle>(std::move(chip));
    handle->line = gpiod_chip_get_line(handle->chip.get(), offset);
    if (handle->line == nullptr)
      return system_failure(node, "asking for line " + std::to_string(offset), errno);
    return handle;
  }
};

Result<GpioChipInfo> describe_gpio_chip(const std::string& node) {
  HAL_TRY(const auto chip, open_chip(node));
  GpioChipInfo info{node, text(gpiod_chip_label(chip.get())), {}};
  for (unsigned offset = 0; offset < gpiod_chip_num_lines(chip.get()); ++offset) {
    gpiod_line* const line = gpiod_chip_get_line(chip.get(), offset);
    if (line == nullptr)
      return system_failure(node, "asking for line " + std::to_string(offset), errno);
    info.lines.push_back({offset, text(gpiod_line_name(line)), text(gpiod_line_consumer(line)),
                          gpiod_line_is_used(line)});
  }
  return info;
}

Result<GpioLine> GpioLine::output(const std::string& node, unsigned offset) {
  HAL_TRY(auto handle, Handle::find(node, offset));
  if (gpiod_line_request_output(handle->line, gpio_consumer, 0) != 0)
    return system_failure(node, "taking line " + std::to_string(offset) + " as output", errno);
  return GpioLine{std::move(handle)};
}

Result<GpioLine> GpioLine::rising_edges(const std::string& node, unsigned offset) {
  HAL_TRY(auto handle, Handle::find(node, offset));
  if (gpiod_line_request_rising_edge_events(handle->line, gpio_consumer) != 0)
    return system_failure(node, "taking line " + std::to_string(offset) + " for its edges", errno);
  return GpioLine{std::move(handle)};
}

int GpioLine::set(bool high) noexcept {
  int result = -1;
  do {
    result = gpiod_line_set_value(handle_->line, high ? 1 : 0);
  } while (result != 0 && errno == EINTR);
  return result == 0 ? 0 : errno;
}

int GpioLine::read_edges(std::span<TimePoint> edges) noexcept {
  std::array<gpiod_line_event, kernel_buffer> events;
  const int file = gpiod_line_event_get_fd(handle_->line);
  pollfd waiting{file, POLLIN, 0}; // the read below would wait
  int ready = 0;
  do {
    ready = ::poll(&waiting, 1, 0);
  } while (ready == -1 && errno == EINTR);
  if (ready <= 0)
    return ready == 0 ? 0 : -errno;
  int count = 0;
  do {
    count = gpiod_line_event_read_fd_multiple(
        file, events.data(), static_cast<unsigned>(std::min(edges.size(), events.size())));
  } while (count < 0 && errno == EINTR);
  if (count < 0)
    return -errno;
  for (int i = 0; i < count; ++i) {
    const timespec& t = events[static_cast<std::size_t>(i)].ts;
    edges[static_cast<std::size_t>(i)] =
        TimePoint{std::chrono::seconds{t.tv_sec} + Duration{t.tv_nsec}};
  }
  return count;
}

GpioLine::GpioLine(std::unique_ptr<Handle> handle) : handle_{std::move(handle)} {}
GpioLine::GpioLine(GpioLine&&) noexcept = default;
GpioLine& GpioLine::operator=(GpioLine&&) noexcept = default;
GpioLine::~GpioLine() = default;

} // namespace octascope::hal::linux_backend
