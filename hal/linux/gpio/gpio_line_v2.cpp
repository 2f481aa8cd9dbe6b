// libgpiod 2.x.
#include <algorithm>
#include <cerrno>

#include <gpiod.h>
#include <poll.h>

#include "hal/linux/gpio/gpio_line.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

template <auto free> struct Freer {
  template <class T> void operator()(T* object) const { free(object); }
};
template <class T, auto free> using Owned = std::unique_ptr<T, Freer<free>>;

using Chip = Owned<gpiod_chip, gpiod_chip_close>;
using ChipInfo = Owned<gpiod_chip_info, gpiod_chip_info_free>;
using LineInfo = Owned<gpiod_line_info, gpiod_line_info_free>;
using Settings = Owned<gpiod_line_settings, gpiod_line_settings_free>;
using LineConfig = Owned<gpiod_line_config, gpiod_line_config_free>;
using RequestConfig = Owned<gpiod_request_config, gpiod_request_config_free>;
using Request = Owned<gpiod_line_request, gpiod_line_request_release>;
using EdgeBuffer = Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free>;

// What is no chip, or none any more.
int absent_if_gone(int error_number) {
  return error_number == ENODEV || error_number == ENOTTY ? ENOENT : error_number;
}

Result<Chip> open_chip(const std::string& node) {
  Chip chip{gpiod_chip_open(node.c_str())};
  if (!chip)
    return system_failure(node, "opening", absent_if_gone(errno));
  return chip;
}

std::string text(const char* maybe) {
  return maybe != nullptr ? maybe : "";
}

// The request, or null with errno.
Request take_line(gpiod_chip* chip, unsigned offset, gpiod_line_settings* settings) {
  const LineConfig lines{gpiod_line_config_new()};
  const RequestConfig config{gpiod_request_config_new()};
  if (!lines || !config ||
      gpiod_line_config_add_line_settings(lines.get(), &offset, 1, settings) != 0)
    return {};
  gpiod_request_config_set_consumer(config.get(), gpio_consumer);
  return Request{gpiod_chip_request_lines(chip, config.get(), lines.get())};
}

} // namespace

struct GpioLine::Handle {
  Request request; // keeps the line when the chip is closed
  unsigned offset = 0;
  EdgeBuffer edges; // of an input

  static Result<std::unique_ptr<Handle>> take(const std::string& node, unsigned offset,
                                              bool output) {
    HAL_TRY(const auto chip, open_chip(node));
    const Settings settings{gpiod_line_settings_new()};
    const bool described =
        settings &&
        (output
             ? gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT) ==
                       0 &&
                   gpiod_line_settings_set_output_value(settings.get(),
                                                        GPIOD_LINE_VALUE_INACTIVE) == 0
             : gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT) == 0 &&
                   gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_RISING) ==
                       0 &&
                   gpiod_line_settings_set_event_clock(settings.get(),
                                                       GPIOD_LINE_CLOCK_MONOTONIC) == 0);
    auto handle = std::make_unique<Handle>();
    handle->offset = offset;
    if (described)
      handle->request = take_line(chip.get(), offset, settings.get());
    if (handle->request && !output)
      handle->edges.reset(gpiod_edge_event_buffer_new(kernel_buffer));
    if (!handle->request || (!output && !handle->edges))
      return system_failure(node,
                            "taking line " + std::to_string(offset) +
                                (output ? " as output" : " for its edges"),
                            errno);
    return handle;
  }
};

Result<GpioChipInfo> describe_gpio_chip(const std::string& node) {
  HAL_TRY(const auto chip, open_chip(node));
  const ChipInfo about{gpiod_chip_get_info(chip.get())};
  if (!about)
    return system_failure(node, "asking what it is", absent_if_gone(errno));
  GpioChipInfo info{node, text(gpiod_chip_info_get_label(about.get())), {}};
  for (unsigned offset = 0; offset < gpiod_chip_info_get_num_lines(about.get()); ++offset) {
    const LineInfo line{gpiod_chip_get_line_info(chip.get(), offset)};
    if (!line)
      return system_failure(node, "asking for line " + std::to_string(offset), errno);
    info.lines.push_back({offset, text(gpiod_line_info_get_name(line.get())),
                          text(gpiod_line_info_get_consumer(line.get())),
                          gpiod_line_info_is_used(line.get())});
  }
  return info;
}

Result<GpioLine> GpioLine::output(const std::string& node, unsigned offset) {
  HAL_TRY(auto handle, Handle::take(node, offset, true));
  return GpioLine{std::move(handle)};
}

Result<GpioLine> GpioLine::rising_edges(const std::string& node, unsigned offset) {
  HAL_TRY(auto handle, Handle::take(node, offset, false));
  return GpioLine{std::move(handle)};
}

int GpioLine::set(bool high) noexcept {
  int result = -1;
  do {
    result =
        gpiod_line_request_set_value(handle_->request.get(), handle_->offset,
                                     high ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
  } while (result != 0 && errno == EINTR);
  return result == 0 ? 0 : errno;
}

int GpioLine::read_edges(std::span<TimePoint> edges) noexcept {
  pollfd waiting{gpiod_line_request_get_fd(handle_->request.get()), POLLIN, 0};
  int ready = 0; // the read below would wait
  do {
    ready = ::poll(&waiting, 1, 0);
  } while (ready == -1 && errno == EINTR);
  if (ready <= 0)
    return ready == 0 ? 0 : -errno;
  int count = 0;
  do {
    count = gpiod_line_request_read_edge_events(handle_->request.get(), handle_->edges.get(),
                                                std::min(edges.size(), kernel_buffer));
  } while (count < 0 && errno == EINTR);
  if (count < 0)
    return -errno;
  for (int i = 0; i < count; ++i) {
    gpiod_edge_event* const event =
        gpiod_edge_event_buffer_get_event(handle_->edges.get(), static_cast<unsigned long>(i));
    edges[static_cast<std::size_t>(i)] =
        TimePoint{Duration{static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event))}};
  }
  return count;
}

GpioLine::GpioLine(std::unique_ptr<Handle> handle) : handle_{std::move(handle)} {}
GpioLine::GpioLine(GpioLine&&) noexcept = default;
GpioLine& GpioLine::operator=(GpioLine&&) noexcept = default;
GpioLine::~GpioLine() = default;

} // namespace octascope::hal::linux_backend
