#include "firmware-host/supervision/appliance_status.h"

#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/supervision/counters_json.h"
#include "firmware-host/version/version.h"

namespace octascope::firmware_host {

namespace {

using Json = ReportJson;

template <class Value> Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json faults_to_json(const ApplianceStatus& s) {
  Json faults = Json::array();
  for (const pipeline::FaultRecord& f : s.faults)
    faults.push_back({{"device", facts_of(f.kind).device_key()},
                      {"kind", facts_of(f.kind).key},
                      {"message", f.message},
                      {"count", f.count},
                      {"first_s_ago", rounded(hal::to_seconds(s.now - f.first))},
                      {"last_s_ago", rounded(hal::to_seconds(s.now - f.last))}});
  return faults;
}

Json threads_to_json(const ApplianceStatus& s) {
  Json threads = Json::array();
  for (const ThreadState& thread : s.threads)
    threads.push_back({{"name", thread.name},
                       {"stuck", thread.stuck},
                       {"silent_s", rounded(hal::to_seconds(thread.silence))}});
  return threads;
}

Json devices_to_json(const PictureStatus& p) {
  Json devices = Json::object();
  for (const PictureStatus::DeviceLine& device : p.devices)
    devices[device.name] = {{"backend", device.backend}, {"state", to_string(device.state)}};
  return devices;
}

void add_picture(Json& json, const PictureStatus& p, hal::TimePoint now) {
  json["told_s_ago"] = rounded(hal::to_seconds(now - p.told));
  json["simulated"] = p.simulated;
  json["source"] = p.source;
  json["devices"] = devices_to_json(p);
  json["calibration"] = {{"camera", p.calibration.camera},
                         {"line_camera", p.calibration.line_camera},
                         {"verdict", p.calibration.verdict}};
  json["picture"] = {{"liveness", to_string(p.freshness.liveness)},
                     {"age_ms", rounded(hal::to_ms(p.freshness.age))},
                     {"notice", p.notice}};
  const RunCounters& c = p.counters;
  json["rates"] = to_json(c.rates);
  json["volumes"] = {{"acquired", c.volumes.acquired},
                     {"published", c.volumes.published},
                     {"displayed", c.displayed},
                     {"skipped", c.volumes.skipped},
                     {"passed_over", c.volumes.passed_over}};
  json["lost"] = lost_to_json(c);
  json["saturated_lines"] = c.volumes.saturated_lines;
  json["frames"] = {{"drawn", c.frames_drawn}, {"missed", c.frames_missed}};
  json["latency_ms"] = to_json(c.latency);
}

// Of the characters that the format keeps for itself.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '"')
      out += '\\';
    if (c == '\n')
      out += "\\n";
    else
      out += c;
  }
  return out;
}

class Metrics {
public:
  // Before the values of one name.
  Metrics& name(std::string_view name, std::string_view type, std::string_view help) {
    name_ = name;
    fmt::format_to(std::back_inserter(text_), "# HELP octascope_{} {}\n# TYPE octascope_{} {}\n",
                   name, help, name, type);
    return *this;
  }
  template <class Value> Metrics& value(Value value, std::string_view labels = {}) {
    fmt::format_to(std::back_inserter(text_), "octascope_{}{}{}{} {}\n", name_,
                   labels.empty() ? "" : "{", labels, labels.empty() ? "" : "}", value);
    return *this;
  }
  std::string text() { return std::move(text_); }

private:
  std::string text_;
  std::string_view name_;
};

void add_picture(Metrics& m, const PictureStatus& p) {
  const RunCounters& c = p.counters;
  m.name("picture_live", "gauge", "1 while the picture shows what is now.")
      .value(p.freshness.liveness == ui::Liveness::live ? 1 : 0);
  m.name("simulated", "gauge", "1 while any part of the picture is simulated.")
      .value(p.simulated ? 1 : 0);
  m.name("volumes_total", "counter", "Volumes, by what became of them.")
      .value(c.displayed, "fate=\"displayed\"")
      .value(c.volumes.skipped, "fate=\"skipped\"")
      .value(c.volumes.passed_over, "fate=\"passed over\"")
      .value(c.volumes.lost_volumes, "fate=\"lost\"");
  m.name("lost_lines_total", "counter", "Kept lines of sweeps that did not come.")
      .value(c.volumes.lost_lines);
  m.name("lost_b_scans_total", "counter", "B-scans of which no sweep came.")
      .value(c.volumes.lost_b_scans);
  m.name("saturated_lines_total", "counter", "Lines at the camera's full scale.")
      .value(c.volumes.saturated_lines);
  m.name("frames_total", "counter", "Frames drawn.").value(c.frames_drawn);
  m.name("missed_frames_total", "counter", "Refreshes that passed while a frame was drawn.")
      .value(c.frames_missed);
  m.name("latency_ms", "gauge", "Last line of a volume to its first frame, of the whole run.")
      .value(c.latency.p50_ms, "quantile=\"0.5\"")
      .value(c.latency.p95_ms, "quantile=\"0.95\"");
  m.name("device_ready", "gauge", "1 while a device works.");
  for (const PictureStatus::DeviceLine& device : p.devices)
    m.value(
        device.state == hal::DeviceState::ready || device.state == hal::DeviceState::streaming ? 1
                                                                                               : 0,
        fmt::format("device=\"{}\",backend=\"{}\"", escaped(device.name), escaped(device.backend)));
}

} // namespace

std::string_view to_string(ui::Liveness liveness) {
  switch (liveness) {
  case ui::Liveness::waiting: return "waiting";
  case ui::Liveness::live: return "live";
  case ui::Liveness::stale: return "stale";
  case ui::Liveness::veiled: return "veiled";
  case ui::Liveness::frozen: return "frozen";
  case ui::Liveness::replayed: return "replayed";
  }
  return "unknown";
}

std::string_view to_string(ui::ConfigurationState state) {
  switch (state) {
  case ui::ConfigurationState::own: return "own";
  case ui::ConfigurationState::last_good: return "last_good";
  case ui::ConfigurationState::built_in: return "built_in";
  }
  return "unknown";
}

std::string to_json(const ApplianceStatus& s) {
  Json json = {{"version", version()},
               {"uptime_s", rounded(s.uptime_s)},
               {"configuration", s.configuration},
               {"configuration_state", to_string(s.configuration_state)}};
  if (s.picture)
    add_picture(json, *s.picture, s.now);
  json["threads"] = threads_to_json(s);
  json["faults"] = faults_to_json(s);
  json["resident_bytes"] = or_null(s.resident_bytes);
  json["temperature_c"] = or_null(s.temperature_c);
  // A path or a message may be in anything.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_metrics(const ApplianceStatus& s) {
  Metrics m;
  m.name("info", "gauge", "The program.").value(1, fmt::format("version=\"{}\"", version()));
  m.name("uptime_seconds", "gauge", "Since the program was started.").value(rounded(s.uptime_s));
  if (s.picture)
    add_picture(m, *s.picture);
  m.name("thread_stuck", "gauge", "1 while a thread makes no steps.");
  for (const ThreadState& thread : s.threads)
    m.value(thread.stuck ? 1 : 0, fmt::format("thread=\"{}\"", escaped(thread.name)));
  m.name("faults_total", "counter", "Faults, by device and kind.");
  for (const pipeline::FaultRecord& f : s.faults)
    m.value(f.count, fmt::format("device=\"{}\",kind=\"{}\"", facts_of(f.kind).device_key(),
                                 facts_of(f.kind).key));
  if (s.resident_bytes)
    m.name("resident_bytes", "gauge", "Memory of the program.").value(*s.resident_bytes);
  if (s.temperature_c)
    m.name("temperature_celsius", "gauge", "Of the hottest zone.").value(*s.temperature_c);
  return m.text();
}

std::string to_line(const PictureStatus& p) {
  const RunCounters& c = p.counters;
  std::string line = fmt::format(
      "{}{}, {:.1f} volumes/s, {:.0f} frames/s, latency {:.0f} ms, lost {} lines, {} B-scans, {} "
      "volumes",
      to_string(p.freshness.liveness), p.simulated ? ", simulated" : "", c.rates.volumes_per_s,
      c.rates.frames_per_s, c.latency.p50_ms, c.volumes.lost_lines, c.volumes.lost_b_scans,
      c.volumes.lost_volumes);
  if (!p.notice.empty())
    line += "; " + p.notice;
  return line;
}

} // namespace octascope::firmware_host
