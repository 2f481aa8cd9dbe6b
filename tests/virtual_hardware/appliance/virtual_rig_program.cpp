// The virtual_rig for an appliance that others start (tests/image/check: its disk image).
//   virtual_rig configuration FOLDER   writes the appliance's configuration
//   virtual_rig spectra FILE           writes what its camera is to see
//   virtual_rig devices FILE           makes the devices, says so, and keeps them until it is
//   killed
// Exit status 0, or 1 with the reason on standard error; 2: wrong use.
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "tests/virtual_hardware/appliance/virtual_rig.h"

namespace {

using namespace octascope;

int told(const hal::Result<>& result) {
  if (!result)
    fmt::print(stderr, "virtual_rig: {}\n", result.error().message);
  return result ? 0 : 1;
}

hal::Result<> keep_devices(const char* spectra_file) {
  if (const std::string missing = tests::virtual_rig_missing(); !missing.empty())
    return hal::fail(hal::ErrorCode::unsupported, missing);
  HAL_TRY(auto spectra, tests::read_virtual_rig_spectra(spectra_file));
  HAL_TRY(const auto virtual_rig, tests::VirtualRig::make(std::move(spectra)));
  fmt::print("virtual_rig: the devices are there\n");
  std::fflush(stdout);
  for (;;)
    ::pause();
}

} // namespace

int main(int count, char** words) {
  const std::string_view command = count > 1 ? words[1] : "";
  if (command == "configuration" && count == 3)
    return told(tests::write_virtual_rig_configuration(words[2], tests::VirtualRigStart::at_boot));
  if (command == "spectra" && count == 3)
    return told(tests::write_virtual_rig_spectra(words[2]));
  if (command == "devices" && count == 3)
    return told(keep_devices(words[2]));
  fmt::print(stderr,
             "virtual_rig: expected 'configuration FOLDER', 'spectra FILE' or 'devices FILE'\n");
  return 2;
}
