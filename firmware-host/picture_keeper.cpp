#include "firmware-host/picture_keeper.h"

#include <chrono>
#include <ctime>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace octascope::firmware_host {

bool PictureKeeper::keep(pipeline::Image picture) {
  using namespace std::chrono_literals;
  if (writing_.valid() && writing_.wait_for(0s) != std::future_status::ready) {
    faults_.add("host", "picture_not_kept", "the last picture is still being written",
                clock_.now());
    return false;
  }
  const std::filesystem::path file = free_name();
  writing_ = std::async(std::launch::async, [this, file, image = std::move(picture)] {
    if (const auto written = pipeline::write_png(file, image); !written)
      faults_.add("host", "picture_not_kept", written.error().message, clock_.now());
  });
  return true;
}

// Two pictures of one second both stay.
std::filesystem::path PictureKeeper::free_name() const {
  const std::string time = fmt::format("{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::filesystem::path file = folder_ / fmt::format("octascope-{}.png", time);
  std::error_code ignored; // what cannot be looked at cannot be written, which is told then
  for (int i = 2; std::filesystem::exists(file, ignored); ++i)
    file = folder_ / fmt::format("octascope-{}-{}.png", time, i);
  return file;
}

} // namespace octascope::firmware_host
