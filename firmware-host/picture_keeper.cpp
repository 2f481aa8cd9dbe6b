#include "firmware-host/picture_keeper.h"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace octascope::firmware_host {

void PictureKeeper::keep(pipeline::Image picture) {
  using namespace std::chrono_literals;
  if (writing_.valid() && writing_.wait_for(0s) != std::future_status::ready) {
    faults_.add("host", "picture_not_kept", "the last picture is still being written",
                clock_.now());
    return;
  }
  const std::string name =
      fmt::format("octascope-{:%Y%m%d-%H%M%S}.png", fmt::localtime(std::time(nullptr)));
  writing_ =
      std::async(std::launch::async, [this, file = folder_ / name, image = std::move(picture)] {
        if (const auto written = pipeline::write_png(file, image); !written)
          faults_.add("host", "picture_not_kept", written.error().message, clock_.now());
      });
}

} // namespace octascope::firmware_host
