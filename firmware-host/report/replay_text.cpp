#include "firmware-host/report/replay_text.h"

#include <fmt/format.h>

#include "hal/plain_text.h"

namespace octascope::firmware_host {

std::string recording_source(const std::filesystem::path& file,
                             const pipeline::RecordingFacts& facts, std::size_t position,
                             std::size_t volumes, double rate) {
  return fmt::format("{}, volume {} of {}{}: {}", hal::shortened(file.filename().string(), 32),
                     position + 1, volumes, rate == 1 ? "" : fmt::format(", at rate {:g}", rate),
                     hal::shortened(facts.source, 32));
}

std::string pause_words(hal::Duration left_out) {
  const long long s = std::chrono::duration_cast<std::chrono::seconds>(left_out).count();
  return s < 3600 ? fmt::format("A pause of {}:{:02} is left out", s / 60, s % 60)
                  : fmt::format("A pause of {} h {:02} min is left out", s / 3600, s / 60 % 60);
}

} // namespace octascope::firmware_host
