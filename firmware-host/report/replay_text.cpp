#include "firmware-host/report/replay_text.h"

#include <string_view>

#include <fmt/format.h>

namespace octascope::firmware_host {

namespace {

constexpr std::size_t longest_subject = 16; // bytes: what finds room beside the other badges

// A name from a file: in one line, and cut between two characters of UTF-8.
std::string in_short(std::string_view text, std::size_t most) {
  std::string out;
  for (const char c : text)
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  if (out.size() <= most)
    return out;
  while (most > 0 && (static_cast<unsigned char>(out[most]) & 0xC0U) == 0x80U)
    --most;
  return out.substr(0, most) + "…";
}

} // namespace

std::string recording_patient(const pipeline::RecordingFacts& facts) {
  const std::string eye = facts.eye == pipeline::Eye::not_said
                              ? "eye not said"
                              : fmt::format("{} eye", to_string(facts.eye));
  if (facts.subject.empty())
    return eye + ", subject not said";
  return fmt::format("{}, subject {}", eye, in_short(facts.subject, longest_subject));
}

std::string recording_source(const std::filesystem::path& file,
                             const pipeline::RecordingFacts& facts, std::size_t position,
                             std::size_t volumes, double rate) {
  return fmt::format("{}, volume {} of {}{}: {}", in_short(file.filename().string(), 32),
                     position + 1, volumes, rate == 1 ? "" : fmt::format(", at rate {:g}", rate),
                     in_short(facts.source, 32));
}

std::string pause_words(hal::Duration left_out) {
  const long long s = std::chrono::duration_cast<std::chrono::seconds>(left_out).count();
  return s < 3600 ? fmt::format("A pause of {}:{:02} is left out", s / 60, s % 60)
                  : fmt::format("A pause of {} h {:02} min is left out", s / 3600, s / 60 % 60);
}

} // namespace octascope::firmware_host
