// The GPIO trigger under its device's contract, on the kernel's gpio-sim.
#include <vector>

#include "tests/contract/galvo_trigger_contract.h"
#include "tests/virtual_hardware/gpio/gpio_bench.h"

namespace octascope::tests {
namespace {

class GpioTriggerBench final : public GalvoTriggerBench {
public:
  hal::GalvoTrigger& trigger() override { return trigger_; }
  hal::Clock& clock() override { return clock_; }
  std::uint64_t pulses_seen() const override { return clock_.rising_edges(); }
  bool can_unplug() const override { return true; }
  void unplug() override { EXPECT_TRUE(chip_->remove()); }
  void replug() override { EXPECT_TRUE(chip_->restore()); }

private:
  std::unique_ptr<SimGpioChip> chip_ = make_trigger_chip();
  WatchingClock clock_{*chip_};
  hal::linux_backend::GpioGalvoTrigger trigger_{clock_};
};

std::vector<GalvoTriggerCase> cases() {
  if (!sim_gpio_missing().empty())
    return {}; // GpioTest says so
  return {{"gpio", [] { return std::make_unique<GpioTriggerBench>(); }}};
}

INSTANTIATE_TEST_SUITE_P(bench, GalvoTriggerContract, testing::ValuesIn(cases()), NameOfCase{});
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(GalvoTriggerContract);

} // namespace
} // namespace octascope::tests
