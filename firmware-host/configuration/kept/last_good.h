// The last configuration that worked, kept in case the machine's own does not.
#pragma once

#include <filesystem>
#include <optional>

#include "firmware-host/configuration/configuration_bundle.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// STATE/last-good links to one of two folders; the other one is rewritten and then linked, so that
// a power cut leaves either the old or the new one, complete.
class LastGood {
public:
  explicit LastGood(std::filesystem::path state_folder) : state_{std::move(state_folder)} {}

  // Empty if there is none.
  std::optional<std::filesystem::path> file() const;

  // Writes nothing if the same is kept already. What was written is validated before it replaces
  // the old one. Blocks on the disk.
  hal::Result<> keep(const ConfigurationBundle& bundle) const;

private:
  std::filesystem::path link() const { return state_ / "last-good"; }
  std::filesystem::path folder_not_in_use() const;

  std::filesystem::path state_;
};

} // namespace octascope::firmware_host
