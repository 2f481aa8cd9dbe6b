// The kernel's virtual display (vkms) as the tests need it.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "hal/linux/kms/drm/card_survey.h"

namespace octascope::tests {

// Empty: there is none. Its connector is named "Virtual-1" or the like.
inline std::optional<hal::linux_backend::kms::Card> find_vkms() {
  for (auto& card : hal::linux_backend::kms::survey())
    if (card.driver == "vkms" && !card.connectors.empty())
      return card;
  return std::nullopt;
}

inline std::filesystem::path status_file(const hal::linux_backend::kms::Card& card) {
  return std::filesystem::path{"/sys/class/drm"} /
         (card_name(card) + "-" + card.connectors[0].name) / "status";
}

// Pulls the cable ("off") or plugs it in ("detect").
inline bool set_cable(const hal::linux_backend::kms::Card& card, const std::string& state) {
  std::ofstream file{status_file(card)};
  file << state << std::flush;
  return file.good();
}

// Runs in the test's place where a test cannot: what is missing.
inline constexpr const char* no_vkms = "no virtual display (vkms) in this kernel";

} // namespace octascope::tests
