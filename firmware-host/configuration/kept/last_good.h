// The configuration that worked last, kept for the day on which the machine's own does not.
#pragma once

#include <filesystem>
#include <optional>

#include "firmware-host/configuration/configuration_bundle.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// STATE/last-good is a link to one of two folders, of which the other is written anew: it changes
// at once and as a whole, and a power cut leaves the old one or the new one.
class LastGood {
public:
  explicit LastGood(std::filesystem::path state_folder) : state_{std::move(state_folder)} {}

  // Where there is one.
  std::optional<std::filesystem::path> file() const;

  // Writes nothing where the same is kept already. What was written is validated before it takes
  // the place of the old one. Takes as long as the disk does.
  hal::Result<> keep(const ConfigurationBundle& bundle) const;

private:
  std::filesystem::path link() const { return state_ / "last-good"; }
  std::filesystem::path folder_not_in_use() const;

  std::filesystem::path state_;
};

} // namespace octascope::firmware_host
