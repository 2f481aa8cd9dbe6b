#include "firmware-host/commands/devices/status_text.h"

#include <cstdint>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace octascope::firmware_host {

namespace {

using Json = nlohmann::ordered_json;

// An older or newer appliance may leave keys out: then there is nothing to say of them.
double number(const Json& json, const char* group, const char* key) {
  const auto found = json.find(group);
  return found == json.end() || !found->is_object() ? 0.0 : found->value(key, 0.0);
}

std::string span_of(double seconds) {
  const auto whole = static_cast<std::int64_t>(seconds);
  return whole >= 3600 ? fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60)
                       : fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

class Words {
public:
  template <class... Arguments>
  void line(std::string_view subject, fmt::format_string<Arguments...> format,
            Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), "{:<14}", subject);
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }
  std::string text_;
};

// Which camera it is of, against the one that is open.
std::string calibration_words(const Json& calibration) {
  const std::string named = calibration.value("camera", "");
  const std::string open = calibration.value("line_camera", "");
  const std::string verdict = calibration.value("verdict", "unknown");
  if (verdict == "another")
    return fmt::format("ANOTHER CAMERA'S: of {}, and {} is open", named, open);
  if (verdict == "same")
    return "of this camera, " + open;
  return named.empty() ? fmt::format("names no camera; open is {}",
                                     open.empty() ? "one that tells nothing" : open)
                       : fmt::format("of {}; the open one tells nothing of itself", named);
}

void add_picture(Words& words, const Json& json) {
  const Json& picture = json.at("picture");
  const bool simulated = json.value("simulated", false);
  words.line("picture", "{}{}{}, told {:.1f} s ago", picture.value("liveness", "unknown"),
             simulated ? ", SIMULATED: " : ": ", json.value("source", ""),
             json.value("told_s_ago", 0.0));
  if (const std::string notice = picture.value("notice", ""); !notice.empty())
    words.line("notice", "{}", notice);
  for (const auto& [name, device] : json.at("devices").items())
    words.line(name, "{}, {}", device.value("backend", ""), device.value("state", ""));
  if (const auto calibration = json.find("calibration"); calibration != json.end())
    words.line("calibration", "{}", calibration_words(*calibration));
  words.line("rates", "{:.2f} volumes/s, {:.2f} shown, {:.0f} lines/s, {:.1f} frames/s",
             number(json, "rates", "volumes_per_s"), number(json, "rates", "shown_volumes_per_s"),
             number(json, "rates", "lines_per_s"), number(json, "rates", "frames_per_s"));
  words.line("volumes", "{:.0f} acquired, {:.0f} displayed, {:.0f} skipped, {:.0f} passed over",
             number(json, "volumes", "acquired"), number(json, "volumes", "displayed"),
             number(json, "volumes", "skipped"), number(json, "volumes", "passed_over"));
  words.line("lost", "{:.0f} lines, {:.0f} B-scans, {:.0f} volumes", number(json, "lost", "lines"),
             number(json, "lost", "b_scans"), number(json, "lost", "volumes"));
  words.line("latency", "{:.0f} ms median, {:.0f} ms p95", number(json, "latency_ms", "p50"),
             number(json, "latency_ms", "p95"));
}

void add_rest(Words& words, const Json& json) {
  if (json.value("resident_bytes", Json{}).is_number())
    words.line("memory", "{:.0f} MiB", json["resident_bytes"].get<double>() / (1 << 20));
  if (json.value("temperature_c", Json{}).is_number())
    words.line("temperature", "{:.0f} °C", json["temperature_c"].get<double>());
  for (const Json& thread : json.value("threads", Json::array()))
    if (thread.value("stuck", false))
      words.line("STUCK", "thread {}, for {:.0f} s", thread.value("name", ""),
                 thread.value("silent_s", 0.0));
  for (const Json& fault : json.value("faults", Json::array()))
    words.line("fault", "{} {} ×{}, last {} ago: {}", fault.value("device", ""),
               fault.value("kind", ""), fault.value("count", 0U),
               span_of(fault.value("last_s_ago", 0.0)), fault.value("message", ""));
}

// The file in use, and whether it is the one that was asked for: the fault beside it says why not.
std::string configuration_in_use(const Json& json) {
  const std::string state = json.value("configuration_state", "own");
  if (state == "built_in")
    return "REFUSED: the defaults are used";
  const std::string file = json.value("configuration", "");
  if (state == "last_good")
    return fmt::format("REFUSED: the last good one is used, {}", file);
  return file.empty() ? "none: the defaults" : file;
}

} // namespace

hal::Result<std::string> status_words(const std::string& answer) {
  const Json json = Json::parse(answer, nullptr, false);
  if (!json.is_object() || !json.contains("uptime_s"))
    return hal::fail(
        hal::ErrorCode::bad_data,
        "what answered is no octascope: expected one JSON object with its status; look "
        "whose socket that is");
  Words words;
  words.line("octascope", "{}, up {}", json.value("version", "?"),
             span_of(json.value("uptime_s", 0.0)));
  words.line("configuration", "{}", configuration_in_use(json));
  if (json.contains("picture") && json.contains("devices"))
    add_picture(words, json);
  else
    words.line("picture", "none yet");
  add_rest(words, json);
  return std::move(words.text_);
}

} // namespace octascope::firmware_host
