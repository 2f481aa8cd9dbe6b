// The virtual_rig for an appliance that others start (tests/image/check: its disk image; by hand:
// CONTRIBUTING.md).
//   virtual_rig configuration FOLDER   writes the appliance's configuration
//   virtual_rig spectra FILE           writes what its camera is to see
//   virtual_rig devices FILE           makes the devices, says so, and keeps them until it is
//   killed
//   virtual_rig beam FILE              likewise; the camera sees the phantom that FILE names, another one
//                                      as soon as another is written into it
// Exit status 0, or 1 with the reason on standard error; 2: wrong use.
#include <cstdio>
#include <fstream>
#include <string>
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

// Empty while it is being written.
std::string phantom_named_in(const char* file) {
  std::string name;
  std::ifstream{file} >> name;
  return name;
}

hal::Result<> keep_beam(const char* file) {
  if (const std::string missing = tests::virtual_rig_missing(); !missing.empty())
    return hal::fail(hal::ErrorCode::unsupported, missing);
  std::string under_the_beam = phantom_named_in(file);
  HAL_TRY(auto spectra, tests::virtual_rig_phantom(1, under_the_beam));
  HAL_TRY(const auto rig, tests::VirtualRig::make(std::move(spectra)));
  for (;; ::usleep(200'000)) {
    if (const std::string name = phantom_named_in(file); !name.empty() && name != under_the_beam) {
      under_the_beam = name;
      auto another = tests::virtual_rig_phantom(1, name);
      if (another)
        rig->look_at(std::move(*another));
      fmt::print("virtual_rig: {}\n",
                 another ? "under the beam lies " + name : another.error().message);
      std::fflush(stdout);
    }
  }
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
  if (command == "beam" && count == 3)
    return told(keep_beam(words[2]));
  fmt::print(stderr, "virtual_rig: expected 'configuration FOLDER', 'spectra FILE', 'devices FILE' "
                     "or 'beam FILE'\n");
  return 2;
}
