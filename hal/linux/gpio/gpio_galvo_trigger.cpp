#include "hal/linux/gpio/gpio_galvo_trigger.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "hal/linux/gpio/gpio_lookup.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

using Take = Result<GpioLine> (*)(const std::string& node, unsigned offset);

Result<GpioLine> take(std::string_view wanted, Take request) {
  HAL_TRY(const auto address, find_gpio_line(survey_gpio(), wanted));
  auto line = request(address.node, address.offset);
  if (line || line.error().code != ErrorCode::busy)
    return line;
  // Who has it is known to the chip alone; it may have been given back meanwhile.
  const std::string holder = gpio_complaint(survey_gpio(), wanted);
  return fail(ErrorCode::busy, holder.empty() ? line.error().message : holder);
}

} // namespace

GpioGalvoTrigger::GpioGalvoTrigger(Clock& clock, GpioTriggerSettings settings)
    : clock_(clock), settings_(std::move(settings)),
      ledger_(static_cast<std::uint64_t>(std::max(1, settings_.sync_edges_per_pulse))) {}

GpioGalvoTrigger::~GpioGalvoTrigger() {
  do_close();
}

Result<> GpioGalvoTrigger::do_open(const GalvoTriggerConfig& config) {
  if (settings_.sync_edges_per_pulse < 1 ||
      std::cmp_greater(settings_.sync_edges_per_pulse, GpioLine::kernel_buffer))
    return fail(
        ErrorCode::invalid_argument,
        "GPIO galvo trigger: sync_edges_per_pulse is {}, expected 1 to {}, what the kernel keeps",
        settings_.sync_edges_per_pulse, GpioLine::kernel_buffer);
  config_ = config;
  Result<> ready = take_lines();
  if (ready && config_.pulse_width > longest_wait)
    ready = timer_.start([this] { end_pulse(); });
  if (!ready) {
    do_close();
    return ready;
  }
  set_state(DeviceState::ready);
  return {};
}

Result<> GpioGalvoTrigger::take_lines() {
  HAL_TRY(auto line, take(settings_.line, GpioLine::output));
  line_.emplace(std::move(line));
  held_.store(&*line_, std::memory_order_release);
  level_.store(Level::low, std::memory_order_release);
  if (settings_.sync_line.empty())
    return {};
  HAL_TRY(auto sync, take(settings_.sync_line, GpioLine::rising_edges));
  sync_.emplace(std::move(sync));
  sync_works_.store(true, std::memory_order_relaxed);
  return {};
}

Result<TimePoint> GpioGalvoTrigger::do_pulse() {
  await_low();
  read_sync_edges();
  const TimePoint before = clock_.now();
  if (const int error = line_->set(true); error != 0)
    return lost(error);
  const TimePoint after = clock_.now();
  level_.store(Level::high, std::memory_order_release);
  pulse_end_ = after + config_.pulse_width;
  if (config_.pulse_width <= longest_wait || timer_.end_at(pulse_end_) != 0) {
    clock_.sleep_until(pulse_end_);
    if (const int error = end_pulse(); error != 0)
      return lost(error);
  }
  // The edge was made somewhere within the system call: the middle is off by half of it at most.
  const TimePoint edge = before + (after - before) / 2;
  if (!settings_.sync_line.empty()) // else nobody is asked
    ledger_.pulse(edge);
  pulses_.fetch_add(1, std::memory_order_relaxed);
  missed_.store(ledger_.missed(), std::memory_order_relaxed);
  return edge;
}

// No edge can rise before the last one fell.
void GpioGalvoTrigger::await_low() {
  if (level_.load(std::memory_order_acquire) == Level::low)
    return;
  clock_.sleep_until(pulse_end_);
  end_pulse();
  while (level_.load(std::memory_order_acquire) != Level::low)
    clock_.sleep_for(std::chrono::microseconds{20}); // the other thread is in its system call
}

int GpioGalvoTrigger::end_pulse() noexcept {
  Level expected = Level::high;
  if (!level_.compare_exchange_strong(expected, Level::falling, std::memory_order_acq_rel))
    return 0;
  const int error = line_->set(false);
  level_.store(Level::low, std::memory_order_release);
  return error;
}

void GpioGalvoTrigger::read_sync_edges() {
  if (!sync_ || !sync_works_.load(std::memory_order_relaxed))
    return;
  const int count = sync_->read_edges(edges_);
  if (count < 0) { // the trigger goes on without its answers: they are counted as missed
    sync_works_.store(false, std::memory_order_relaxed);
    return;
  }
  for (int i = 0; i < count; ++i)
    ledger_.edge(edges_[static_cast<std::size_t>(i)]);
  if (count > 0)
    last_sync_ns_.store(edges_[static_cast<std::size_t>(count - 1)].time_since_epoch().count(),
                        std::memory_order_relaxed);
  sync_edges_.store(ledger_.edges(), std::memory_order_relaxed);
  unexpected_.store(ledger_.unexpected(), std::memory_order_relaxed);
  sync_delay_ns_.store(ledger_.delay().value_or(Duration{}).count(), std::memory_order_relaxed);
}

tl::unexpected<Error> GpioGalvoTrigger::lost(int error_number) {
  line_->set(false);
  level_.store(Level::low, std::memory_order_release);
  set_state(DeviceState::failed);
  return system_failure(fmt::format("GPIO galvo trigger, line \"{}\"", settings_.line),
                        "setting it", error_number);
}

void GpioGalvoTrigger::do_close() {
  timer_.stop();
  held_.store(nullptr, std::memory_order_release);
  if (line_)
    line_->set(false); // a chip that is gone has no level
  level_.store(Level::low, std::memory_order_release);
  line_.reset();
  sync_.reset();
  sync_works_.store(false, std::memory_order_relaxed);
  ledger_.forget_pulse();
  set_state(DeviceState::absent);
}

void GpioGalvoTrigger::make_safe() noexcept {
  if (GpioLine* const line = held_.load(std::memory_order_acquire))
    line->set(false);
}

GpioTriggerCounters GpioGalvoTrigger::counters() const {
  return {pulses_.load(std::memory_order_relaxed),
          sync_edges_.load(std::memory_order_relaxed),
          missed_.load(std::memory_order_relaxed),
          unexpected_.load(std::memory_order_relaxed),
          sync_works_.load(std::memory_order_relaxed),
          Duration{sync_delay_ns_.load(std::memory_order_relaxed)},
          TimePoint{Duration{last_sync_ns_.load(std::memory_order_relaxed)}}};
}

} // namespace octascope::hal::linux_backend
