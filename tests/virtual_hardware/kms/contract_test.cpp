// The contract of every display, on the kernel's virtual one: by atomic commits and by the older
// calls, with and without margins.
#include <optional>
#include <string>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/contract/display_contract.h"
#include "tests/virtual_hardware/kms/vkms_card.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::KmsConfig;

// The suite asks for 320x200, which no monitor lists: computed timings.
KmsConfig contract_config() {
  KmsConfig config;
  config.mode = "320x200M@60";
  return config;
}

KmsConfig legacy_config() {
  KmsConfig config = contract_config();
  config.atomic = false;
  return config;
}

// 320x200 are left of 400x250.
KmsConfig margins_config() {
  KmsConfig config;
  config.mode = "400x250M@60";
  config.overscan = {15, 5, 4, 16};
  return config;
}

template <auto Config> struct KmsMaker {
  hal::linux_backend::MonotonicClock clock;
  hal::linux_backend::KmsDisplay kms{clock, Config()};

  hal::Display& display() { return kms; }
  std::optional<std::string> unavailable() {
    return find_vkms() ? std::nullopt : std::optional<std::string>{no_vkms};
  }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Atomic, DisplayContract, KmsMaker<contract_config>);
INSTANTIATE_TYPED_TEST_SUITE_P(Legacy, DisplayContract, KmsMaker<legacy_config>);
INSTANTIATE_TYPED_TEST_SUITE_P(Margins, DisplayContract, KmsMaker<margins_config>);

} // namespace
} // namespace octascope::tests
