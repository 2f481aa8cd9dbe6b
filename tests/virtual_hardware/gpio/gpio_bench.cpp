#include "tests/virtual_hardware/gpio/gpio_bench.h"

#include <string>

#include <unistd.h>

namespace octascope::tests {

std::unique_ptr<SimGpioChip> make_trigger_chip() {
  auto chip = SimGpioChip::make("octascope-" + std::to_string(::getpid()),
                                {"", "", "", "octascope-trigger", "", "octascope-sync"});
  EXPECT_TRUE(chip) << chip.error().message;
  return chip ? std::move(*chip) : nullptr;
}

void GpioTest::SetUp() {
  if (const std::string missing = sim_gpio_missing(); !missing.empty())
    GTEST_SKIP() << missing;
  chip_ = make_trigger_chip();
  ASSERT_TRUE(chip_);
}

bool GpioTest::await_level(bool high) {
  const hal::TimePoint limit = clock_.now() + std::chrono::seconds{10};
  while (chip_->level(trigger_line) != high) {
    if (clock_.now() > limit)
      return false;
    clock_.sleep_for(std::chrono::milliseconds{1});
  }
  return true;
}

} // namespace octascope::tests
