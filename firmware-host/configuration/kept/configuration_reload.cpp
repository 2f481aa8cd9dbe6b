#include "firmware-host/configuration/kept/configuration_reload.h"

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
  if (auto read = reading_.take())
    return read;
  if (asked_ && now - *asked_ >= settled_after &&
      reading_.start([file = file_, options = options_] { return read_whole(file, options); }))
    asked_.reset();
  return std::nullopt;
}

} // namespace octascope::firmware_host
