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

Badge& add_badge(HudText& hud, BadgeKind kind) {
  Badge& badge = hud.badges[hud.badge_count++];
  badge.kind = kind;
  return badge;
}

void add_freshness_badge(HudText& hud, const Freshness& freshness) {
  switch (freshness.liveness) {
  case Liveness::live:
  case Liveness::replayed: return; // a badge of its own says so, in every state
  case Liveness::waiting:
    add_badge(hud, BadgeKind::waiting).text.format("WAITING FOR THE FIRST VOLUME");
    return;
  case Liveness::stale:
    format_age(add_badge(hud, BadgeKind::stale).text, "STALE", freshness.age);
    return;
  case Liveness::veiled:
    format_age(add_badge(hud, BadgeKind::veiled).text, "NO LIVE PICTURE", freshness.age);
    return;
  case Liveness::frozen: {
    const auto [minutes, seconds] = split(freshness.frozen_for);
    add_badge(hud, BadgeKind::frozen).text.format("FROZEN {}:{:02}", minutes, seconds);
    return;
  }
  }
}

void add_incomplete_badge(HudText& hud, int count, std::string_view one, std::string_view more) {
  if (count > 0)
    add_badge(hud, BadgeKind::incomplete).text.format("{} {}", count, count == 1 ? one : more);
}

// First of all: whatever else is said of the picture, it is not the patient's of now.
void add_replay_badge(HudText& hud, const ReplayStatus& replay) {
  FixedText<48>& text = add_badge(hud, BadgeKind::replay).text;
  if (replay.recorded.empty())
    text.format("REPLAY");
  else
    text.format("REPLAY {}", replay.recorded);
}

void compose_badges(HudText& hud, const Status& status) {
  if (status.replay)
    add_replay_badge(hud, *status.replay);
  add_freshness_badge(hud, status.freshness);
  if (status.simulated)
    add_badge(hud, BadgeKind::simulated).text.format("SIMULATED");
  if (hud.vessels.shown && !status.vessels.registered)
    add_badge(hud, BadgeKind::unregistered).text.format("VESSELS NOT REGISTERED");
  if (status.configuration != ConfigurationState::own)
    add_badge(hud, BadgeKind::configuration)
        .text.format("{}", status.configuration == ConfigurationState::last_good ? "older setup"
                                                                                 : "scale unknown");
  if (status.another_camera)
    add_badge(hud, BadgeKind::calibration).text.format("another camera's calibration");
  if (status.replay && !status.replay->whose.empty())
    add_badge(hud, BadgeKind::whose).text.format("{}", status.replay->whose);
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

// Vessels have a cell while they are loaded, or where they could not be.
void format_vessels(StatusCell& cell, const VesselStatus& vessels) {
  const bool loading = vessels.state == VesselStatus::State::loading;
  if (!loading && vessels.state != VesselStatus::State::failed)
    return;
  cell.label = "Vessels";
  if (loading)
    cell.value.format("loading {:.0f} %", std::floor(vessels.progress * 100));
  else
    cell.value.format("not loaded");
  cell.tone = loading ? Tone::normal : Tone::warning;
}

// Whose it is belongs to it: a recording of the wrong eye is worse than none.
void format_recording(StatusCell& cell, const RecordingStatus& recording) {
  if (!recording.on)
    return;
  const auto [minutes, seconds] = split(recording.lasted);
  cell.label = "Recording";
  if (recording.not_kept > 0) {
    cell.tone = Tone::warning;
    cell.value.format("{}:{:02}, {} not kept", minutes, seconds, recording.not_kept);
    return;
  }
  const std::string_view whose = recording.eye == pipeline::Eye::left    ? "left eye"
                                 : recording.eye == pipeline::Eye::right ? "right eye"
                                                                         : "eye not said";
  cell.value.format("{}:{:02}, {}", minutes, seconds, whose);
}

void compose_cells(HudText& hud, const ViewState& view, const Status& status) {
  auto& [volumes, lines, frames, latency, lost, window, vessels, recording] = hud.cells;
  volumes.label = "Volumes/s";
  volumes.value.format("{:.1f}", status.volumes_per_s);
  if (!status.replay) // no line comes
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
  lost.label = "Lost lines / B-scans / vol.";
  format_losses(lost, status.losses);
  window.label = "Window";
  window.value.format("{:.0f} to {:.0f} dB", view.window_offset_db,
                      view.window_offset_db + view.window_size_db);
  format_vessels(vessels, status.vessels);
  format_recording(recording, status.recording);
}

// A nudge by hand leaves the residual of the points behind.
void compose_registration(FixedText<40>& text, const ViewState& view, const VesselStatus& vessels) {
  if (view.vessel_nudge.any())
    text.format("adjusted by hand");
  else if (!vessels.residual_mm)
    text.format("residual unknown");
  else if (*vessels.residual_mm < 0.9995)
    text.format("residual {:.0f} µm", *vessels.residual_mm * 1000);
  else
    text.format("residual {:.4g} mm", *vessels.residual_mm);
}

void compose_vessels(HudText& hud, const ViewState& view, const VesselStatus& vessels) {
  hud.vessels.shown = vessels.state == VesselStatus::State::shown && view.vessels_visible &&
                      view.vessel_opacity > 0;
  if (!hud.vessels.shown)
    return;
  hud.vessels.registered = vessels.registered;
  if (vessels.registered)
    compose_registration(hud.vessels.registration, view, vessels);
  hud.vessels.colouring = view.vessel_colouring;
  // SWC leaves their types to any program: they are the heart's where all three are there.
  const auto& [others, rca, lad, lcx] = vessels.branches;
  if (rca && lad && lcx)
    hud.vessels.branches = {others, rca, lad, lcx};
  if (view.vessel_account)
    hud.vessels.account = vessels.account;
}

void compose_reduction(HudText& hud, const Status& status) {
  const bool merged = hud.vessels.shown && status.vessels.account.merged > 0;
  const std::string_view vessels = merged ? "thinnest vessels merged" : "";
  if (!status.reduced_quality) {
    hud.reduced.format("{}", vessels);
    return;
  }
  hud.reduced.format("quality reduced to {:.0f} %{}{}",
                     std::floor(std::clamp(*status.reduced_quality, 0.0F, 1.0F) * 100),
                     merged ? ", " : "", vessels);
}

std::string_view word_for(pipeline::BScanState state) {
  switch (state) {
  case pipeline::BScanState::missing: return "missing";
  case pipeline::BScanState::saturated: return "saturated";
  case pipeline::BScanState::good: return "";
  }
  return "";
}

void compose_captions(HudText& hud, const ViewState& view, const Status& status,
                      const ShownPictures& shown) {
  hud.volume.title.format("Volume");
  hud.volume.note = hud.reduced;
  hud.b_scan.title.format("B-scan");
  hud.crossed.title.format("Crossed B-scan");
  hud.en_face.title.format("En face");
  hud.scope.title.format("Microscope");
  if (shown.volume) {
    hud.b_scan.note.format("{} of {}", view.b_scan + 1, shown.geometry.b_scans);
    hud.crossed.note.format("{} of {}", view.a_scan + 1, shown.geometry.a_scans);
    if (shown.b_scan != pipeline::BScanState::good) {
      // In one piece: "41 of 80 missing" by itself would read as a count.
      hud.b_scan.title.format("{}", "");
      hud.b_scan.note.format("B-scan {} of {}: {}", view.b_scan + 1, shown.geometry.b_scans,
                             word_for(shown.b_scan));
      hud.b_scan.note_tone = Tone::warning;
    }
    hud.en_face.note.format("below the surface");
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
  compose_vessels(hud, view, status.vessels);
  compose_badges(hud, status);
  compose_cells(hud, view, status);
  compose_reduction(hud, status);
  compose_captions(hud, view, status, shown);
  hud.window_changing = status.now < view.echo.until && changes_window(view.echo.action);
  hud.echo = compose_echo(view, status.now, shown.geometry);
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
