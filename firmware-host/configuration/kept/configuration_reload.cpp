#include "firmware-host/configuration/kept/configuration_reload.h"

#include <chrono>
#include <utility>

#include "firmware-host/configuration/configuration_check.h"

namespace octascope::firmware_host {

hal::Result<ReadConfiguration> read_whole(const std::filesystem::path& file,
                                          const RunOptions& options) {
  HAL_TRY(auto configuration, load_whole_configuration(file, options));
  HAL_TRY(auto controls, load_controls(configuration));
  ReadConfiguration read{std::move(configuration), std::move(controls), std::nullopt};
  if (!read.configuration.calibration)
    return read;
  HAL_TRY(auto calibration,
          ConfigurationBundle::gather_calibration(*read.configuration.calibration));
  read.calibration = std::move(calibration);
  return read;
}

std::optional<hal::Result<ReadConfiguration>> ConfigurationReload::take(hal::TimePoint now) {
  using namespace std::chrono_literals;
  if (reading_.valid()) {
    if (reading_.wait_for(0s) != std::future_status::ready)
      return std::nullopt;
    return reading_.get();
  }
  if (asked_ && now - *asked_ >= settled_after) {
    asked_.reset();
    reading_ = std::async(std::launch::async,
                          [file = file_, options = options_] { return read_whole(file, options); });
  }
  return std::nullopt;
}

} // namespace octascope::firmware_host
