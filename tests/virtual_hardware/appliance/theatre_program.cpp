// The theatre for an appliance that others start (tests/image/check: its disk image).
//   theatre configuration FOLDER   writes the appliance's configuration
//   theatre spectra FILE           writes what its camera is to see
//   theatre devices FILE           makes the devices, says so, and keeps them until it is killed
// Exit status 0, or 1 with the reason on standard error; 2: wrong use.
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "tests/virtual_hardware/appliance/theatre.h"

namespace {

using namespace octascope;

int told(const hal::Result<>& result) {
  if (!result)
    fmt::print(stderr, "theatre: {}\n", result.error().message);
  return result ? 0 : 1;
}

hal::Result<> keep_devices(const char* spectra_file) {
  if (const std::string missing = tests::theatre_missing(); !missing.empty())
    return hal::fail(hal::Fault::unsupported, missing);
  auto spectra = tests::read_theatre_spectra(spectra_file);
  if (!spectra)
    return tl::make_unexpected(spectra.error());
  const auto theatre = tests::Theatre::make(std::move(*spectra));
  if (!theatre)
    return tl::make_unexpected(theatre.error());
  fmt::print("theatre: the devices are there\n");
  std::fflush(stdout);
  for (;;)
    ::pause();
}

} // namespace

int main(int count, char** words) {
  const std::string_view command = count > 1 ? words[1] : "";
  if (command == "configuration" && count == 3)
    return told(tests::write_theatre_configuration(words[2], tests::TheatreStart::at_boot));
  if (command == "spectra" && count == 3)
    return told(tests::write_theatre_spectra(words[2]));
  if (command == "devices" && count == 3)
    return told(keep_devices(words[2]));
  fmt::print(stderr,
             "theatre: expected 'configuration FOLDER', 'spectra FILE' or 'devices FILE'\n");
  return 2;
}
