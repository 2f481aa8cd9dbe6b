#include "ui/hud/hud_text.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

// A microscope picture comes some thirty times a second; one second without is no live picture.
constexpr hal::Duration scope_stale_after = std::chrono::seconds{1};

struct MinutesSeconds {
  long long minutes;
  long long seconds;
};

MinutesSeconds split(hal::Duration duration) {
  const long long whole = std::chrono::duration_cast<std::chrono::seconds>(duration).count();
  return {whole / 60, whole % 60};
}

void format_age(FixedText<48>& text, std::string_view word, hal::Duration age) {
  if (age < std::chrono::seconds{60}) {
    // Rounded down: an age is never shown as more than has passed, and 59.97 s is not 60.0.
    text.format("{} {:.1f} s", word, std::floor(hal::to_seconds(age) * 10) / 10);
    return;
  }
  const auto [minutes, seconds] = split(age);
  text.format("{} {}:{:02}", word, minutes, seconds);
}

void add_freshness_badge(HudText& hud, const Freshness& freshness) {
  Badge badge;
  switch (freshness.liveness) {
  case Liveness::live: return;
  case Liveness::waiting:
    badge.kind = BadgeKind::waiting;
    badge.text.format("WAITING FOR THE FIRST VOLUME");
    break;
  case Liveness::stale:
    badge.kind = BadgeKind::stale;
    format_age(badge.text, "STALE", freshness.age);
    break;
  case Liveness::veiled:
    badge.kind = BadgeKind::veiled;
    format_age(badge.text, "NO LIVE PICTURE", freshness.age);
    break;
  case Liveness::frozen: {
    const auto [minutes, seconds] = split(freshness.frozen_for);
    badge.kind = BadgeKind::frozen;
    badge.text.format("FROZEN {}:{:02}", minutes, seconds);
    break;
  }
  }
  hud.badges[hud.badge_count++] = badge;
}

void add_incomplete_badge(HudText& hud, int count, std::string_view one, std::string_view more) {
  if (count <= 0)
    return;
  Badge& badge = hud.badges[hud.badge_count++];
  badge.kind = BadgeKind::incomplete;
  badge.text.format("{} {}", count, count == 1 ? one : more);
}

void compose_badges(HudText& hud, const Status& status) {
  add_freshness_badge(hud, status.freshness);
  if (status.simulated) {
    Badge& badge = hud.badges[hud.badge_count++];
    badge.kind = BadgeKind::simulated;
    badge.text.format("SIMULATED");
  }
  add_incomplete_badge(hud, status.missing_b_scans, "B-scan missing", "B-scans missing");
  add_incomplete_badge(hud, status.saturated_lines, "line saturated", "lines saturated");
}

void format_losses(StatusCell& cell, const Losses& losses) {
  if (!losses.any()) {
    cell.value.format("none");
    return;
  }
  cell.tone = Tone::warning;
  cell.value.format("{} / {} / {}", losses.lines, losses.b_scans, losses.volumes);
}

void compose_cells(HudText& hud, const ViewState& view, const Status& status) {
  auto& [volumes, lines, frames, latency, lost, window] = hud.cells;
  volumes.label = "Volumes/s";
  volumes.value.format("{:.1f}", status.volumes_per_s);
  lines.label = "Lines/s";
  if (status.lines_per_s < 999'500)
    lines.value.format("{:.0f} k", status.lines_per_s * 1e-3);
  else
    lines.value.format("{:.2f} M", status.lines_per_s * 1e-6);
  frames.label = "Frames/s";
  frames.value.format("{:.0f}", status.frames_per_s);
  latency.label = "Latency p50 / p95";
  if (status.latency_p50_ms && status.latency_p95_ms)
    latency.value.format("{:.0f} / {:.0f} ms", *status.latency_p50_ms, *status.latency_p95_ms);
  else
    latency.value.format("–");
  lost.label = "Lost lines / B-scans / volumes";
  format_losses(lost, status.losses);
  window.label = "Window";
  window.value.format("{:.0f} to {:.0f} dB", view.window_offset_db,
                      view.window_offset_db + view.window_size_db);
}

void compose_captions(HudText& hud, const ViewState& view, const Status& status,
                      const ShownPictures& shown) {
  hud.b_scan.title.format("B-scan");
  hud.en_face.title.format("En face");
  hud.scope.title.format("Microscope");
  if (shown.volume) {
    switch (shown.b_scan) {
    case pipeline::BScanState::missing:
      hud.b_scan.note.format("{} of {} missing", view.b_scan + 1, shown.geometry.b_scans);
      hud.b_scan.note_tone = Tone::warning;
      break;
    case pipeline::BScanState::saturated:
      hud.b_scan.note.format("{} of {} saturated", view.b_scan + 1, shown.geometry.b_scans);
      hud.b_scan.note_tone = Tone::warning;
      break;
    case pipeline::BScanState::good:
      hud.b_scan.note.format("{} of {}", view.b_scan + 1, shown.geometry.b_scans);
      break;
    }
    hud.en_face.note.format("mean, auto contrast");
  }
  if (!shown.scope || !shown.scope_time) {
    hud.scope.note.format("no picture");
    return;
  }
  const hal::Duration age = status.now - *shown.scope_time;
  hud.scope_stale = age > scope_stale_after;
  if (hud.scope_stale) {
    hud.scope.note.format("stale {:.0f} s", std::floor(hal::to_seconds(age)));
    hud.scope.note_tone = Tone::warning;
  }
}

} // namespace

HudText compose_hud_text(const ViewState& view, const Status& status, const ShownPictures& shown) {
  HudText hud;
  hud.liveness = status.freshness.liveness;
  compose_badges(hud, status);
  compose_cells(hud, view, status);
  compose_captions(hud, view, status, shown);
  hud.echo = compose_echo(view, status.now, shown.geometry.b_scans);
  if (view.legend_visible)
    hud.legend = view.legend_of_keys ? status.key_legend : status.legend;
  hud.selected = view.selected;
  hud.devices = status.devices;
  hud.device_count = std::min(status.device_count, Status::most_devices);
  hud.source.format("{}", status.source_description);
  hud.notice.format("{}", status.notice);
  return hud;
}

} // namespace octascope::ui
