#include "ui/hud/hud_text.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

// A microscope picture comes some thirty times a second; one second without is no live picture.
constexpr hal::Duration scope_stale_after = std::chrono::seconds{1};

// What has several pages shows each so long.
constexpr hal::Duration page_time = std::chrono::seconds{6};
constexpr std::size_t one_page = 40; // bytes that every picture has room for

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

// Rounded down as every age is: seen at rest, the figures stand still.
void add_rolling_badge(HudText& hud, const RollingStatus& rolling, bool replay) {
  FixedText<48>& text = add_badge(hud, BadgeKind::rolling).text;
  const auto tenths = [](hal::Duration age) { return std::floor(hal::to_seconds(age) * 10) / 10; };
  if (!rolling.possible)
    text.format("whole volumes: {}", replay ? "recording" : "surface");
  else if (rolling.seam)
    text.format("rolling {:.1f} s | {:.1f} s", tenths(rolling.seam->newer),
                tenths(rolling.seam->older));
  else
    text.format("rolling");
}

void say_cut(Badge& badge, const ViewState& view) {
  if (view.cut == CutShape::corner)
    badge.text.format("cut at both B-scans");
  else
    badge.text.format("cut at B-scan {}", view.b_scan + 1);
}

void compose_badges(HudText& hud, const ViewState& view, const Status& status,
                    const ShownPictures& shown) {
  if (status.replay)
    add_replay_badge(hud, *status.replay);
  add_freshness_badge(hud, status.freshness);
  if (status.simulated)
    add_badge(hud, BadgeKind::simulated).text.format("SIMULATED");
  if (status.configuration != ConfigurationState::own)
    add_badge(hud, BadgeKind::configuration)
        .text.format("{}", status.configuration == ConfigurationState::last_good ? "older setup"
                                                                                 : "scale unknown");
  if (status.another_camera)
    add_badge(hud, BadgeKind::calibration).text.format("another camera's calibration");
  add_incomplete_badge(hud, status.missing_b_scans, "B-scan missing", "B-scans missing");
  add_incomplete_badge(hud, status.saturated_lines, "line saturated", "lines saturated");
  if (hud.vessels.shown && !status.vessels.registered)
    add_badge(hud, BadgeKind::unregistered).text.format("VESSELS NOT REGISTERED");
  if (view.cut != CutShape::none && shown.volume)
    say_cut(add_badge(hud, BadgeKind::cut), view);
  if (status.rolling && shown.volume && status.freshness.liveness != Liveness::frozen)
    add_rolling_badge(hud, *status.rolling, status.replay.has_value());
}

Trouble& add_trouble(HudText& hud, Trouble::Sign sign) {
  Trouble& trouble = hud.troubles[hud.trouble_count++];
  trouble.sign = sign;
  return trouble;
}

void add_loss(HudText& hud, std::uint64_t count, std::string_view one, std::string_view more) {
  add_trouble(hud, Trouble::Sign::lost).words.format("{} {} lost", count, count == 1 ? one : more);
}

// What a replay's own badges may leave no room for in the row of badges.
void compose_badges_without_room(HudText& hud) {
  for (std::size_t i = 0; i < hud.badge_count; ++i)
    if (hud.badges[i].kind == BadgeKind::incomplete)
      add_trouble(hud, Trouble::Sign::lost).words.format("{}", hud.badges[i].text.view());
}

// In every picture, also where there is no room for the marks beside the volume.
void add_tree_trouble(HudText& hud, const TracedTreeStatus& tree) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(tree.age).count();
  if (tree.state != TracedTreeStatus::State::shown)
    add_trouble(hud, Trouble::Sign::absent).words.format("no vessel tree");
  else if (hud.vessels.tree_old)
    add_trouble(hud, Trouble::Sign::lost).words.format("tree {} s old", seconds);
}

// What must not wait until somebody asks for the figures.
void compose_troubles(HudText& hud, const Status& status, const FlowShown& flow) {
  if (flow.refused)
    add_trouble(hud, Trouble::Sign::failed).words.format("flow cannot be drawn");
  if (flow.late)
    add_trouble(hud, Trouble::Sign::lost).words.format("no flow on surface: late");
  // Where most of it is not there, its absence must not be taken for vessels that do not flow.
  if (const int lacking = flow.left_out + flow.none; flow.shown && lacking > flow.told) {
    const double share = std::floor(100.0 * lacking / (lacking + flow.told));
    Trouble& trouble = add_trouble(hud, Trouble::Sign::lost);
    if (flow.none == 0)
      trouble.words.format("no flow: {:.0f} % moved", share);
    else
      trouble.words.format("no flow in {:.0f} %", share);
  }
  if (hud.vessels.shown && !status.vessels.registered)
    add_trouble(hud, Trouble::Sign::lost).words.format("vessels not registered");
  if (status.replay)
    compose_badges_without_room(hud);
  for (std::size_t i = 0; i < hud.device_count; ++i) {
    const DeviceStatus& device = hud.devices[i];
    const std::string_view name = facts_of(device.device).name;
    if (device.state == hal::DeviceState::failed)
      add_trouble(hud, Trouble::Sign::failed).words.format("{} failed", name);
    else if (device.state == hal::DeviceState::absent)
      add_trouble(hud, Trouble::Sign::absent).words.format("no {}", name);
  }
  const Losses& losses = status.losses; // the largest that was lost stands for the smaller ones
  if (losses.volumes > 0)
    add_loss(hud, losses.volumes, "volume", "volumes");
  else if (losses.b_scans > 0)
    add_loss(hud, losses.b_scans, "B-scan", "B-scans");
  else if (losses.lines > 0)
    add_loss(hud, losses.lines, "line", "lines");
  if (status.recording.on && status.recording.not_kept > 0)
    add_trouble(hud, Trouble::Sign::lost)
        .words.format("{} not recorded", status.recording.not_kept);
  if (status.vessels.state == VesselStatus::State::loading)
    add_trouble(hud, Trouble::Sign::loading)
        .words.format("vessels {:.0f} %", std::floor(status.vessels.progress * 100));
  if (status.vessels.traced && !hud.vessels.tree.view().empty())
    add_tree_trouble(hud, *status.vessels.traced);
  if (status.vessels.followed && !hud.vessels.tree.view().empty())
    add_trouble(hud, Trouble::Sign::lost).words.format("{}", hud.vessels.tree.view());
  if (status.vessels.state == VesselStatus::State::failed)
    add_trouble(hud, Trouble::Sign::failed).words.format("no vessels");
}

std::string_view words_for(pipeline::Eye eye) {
  switch (eye) {
  case pipeline::Eye::left: return "left eye";
  case pipeline::Eye::right: return "right eye";
  case pipeline::Eye::not_said: return "eye not said";
  }
  return "eye not said";
}

// Rounded down, and never more than anybody plans for.
void format_room(FixedText<96>& text, hal::Duration room) {
  const long long minutes = std::chrono::duration_cast<std::chrono::minutes>(room).count();
  if (minutes < 10)
    text.format("room for {}:{:02}", split(room).minutes, split(room).seconds);
  else if (minutes < 100)
    text.format("room for {} min", minutes);
  else if (minutes < 100 * 60)
    text.format("room for {} h", minutes / 60);
  else
    text.format("room for days");
}

void compose_bar(HudText& hud, const Status& status) {
  hud.eye.format("{}", words_for(status.eye));
  hud.time_of_day.format("{}", status.time_of_day);
  auto& [subject, room, reduced, source] = hud.facts;
  if (!status.subject.empty())
    subject.format("subject {}", status.subject);
  else if (status.replay)
    subject.format("subject not said");
  if (status.recording.on) {
    const auto [minutes, seconds] = split(status.recording.lasted);
    hud.recording.format("REC {}:{:02}", minutes, seconds);
    if (status.recording.room)
      format_room(room, *status.recording.room);
  }
  source.format("{}", status.source_description);
  hud.notice.format("{}", status.notice);
}

void format_losses(StatusCell& cell, const Losses& losses) {
  if (!losses.any()) {
    cell.value.format("none");
    return;
  }
  cell.tone = Tone::warning;
  cell.value.format("{} / {} / {}", losses.lines, losses.b_scans, losses.volumes);
}

void compose_figures(HudText& hud, const ViewState& view, const Status& status,
                     const FlowShown& flow_shown) {
  auto& [volumes, lines, frames, latency, lost, window, flow] = hud.figures;
  volumes.label = "Vol./s shown";
  // Over their last seconds one more may have been shown than came.
  volumes.value.format("{:.1f} of {:.1f}",
                       std::min(status.shown_volumes_per_s, status.volumes_per_s),
                       status.volumes_per_s);
  if (!status.replay) // no line comes
    lines.label = "Lines/s";
  if (status.lines_per_s < 999'500)
    lines.value.format("{:.0f} k", status.lines_per_s * 1e-3);
  else
    lines.value.format("{:.2f} M", status.lines_per_s * 1e-6);
  frames.label = "Frames/s";
  frames.value.format("{:.0f}", status.frames_per_s);
  latency.label = "Latency";
  if (status.latency_p50_ms && status.latency_p95_ms)
    latency.value.format("{:.0f} / {:.0f} ms", *status.latency_p50_ms, *status.latency_p95_ms);
  else
    latency.value.format("–");
  lost.label = "Lines / B. / vol. lost";
  format_losses(lost, status.losses);
  window.label = "Window";
  window.value.format("{:.0f} to {:.0f} dB", view.window_offset_db,
                      view.window_offset_db + view.window_size_db);
  if (!flow_shown.shown)
    return;
  flow.label = "Flow told / moved";
  flow.value.format("{} / {}", flow_shown.told, flow_shown.left_out);
}

// A nudge by hand leaves the residual of the points behind.
void compose_registration(FixedText<40>& text, const ViewState& view, const VesselStatus& vessels) {
  if (view.vessel_nudge.any())
    text.format("adjusted by hand");
  else if (!vessels.residual_mm)
    text.format("residual unknown");
  else if (vessels.followed && vessels.followed->state == FollowedTreeStatus::State::followed)
    text.format("residual {:.0f} µm, overlap {:.0f} %", *vessels.residual_mm * 1000,
                std::floor(vessels.followed->overlap * 100));
  else if (*vessels.residual_mm < 0.9995)
    text.format("residual {:.0f} µm", *vessels.residual_mm * 1000);
  else
    text.format("residual {:.4g} mm", *vessels.residual_mm);
}

// In whole seconds: a tree comes about once a second, and no frame is drawn for its age alone more often.
void compose_traced(VesselMarks& marks, const TracedTreeStatus& tree) {
  using State = TracedTreeStatus::State;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(tree.age).count();
  marks.tree_old = tree.age >= TracedTreeStatus::old_after;
  if (tree.state == State::refused)
    marks.tree.format("no tree: {}", tree.refusal);
  else if (tree.state == State::removed)
    marks.tree.format("no tree: the last is {} s old", seconds);
  else if (seconds == 0)
    marks.tree.format("tree < 1 s old, {} vessels, {:.1f} mm", tree.vessels, tree.length_mm);
  else
    marks.tree.format("tree {} s old, {} vessels, {:.1f} mm", seconds, tree.vessels,
                      tree.length_mm);
}

// Nothing of a tree that is where it belongs.
void compose_followed(VesselMarks& marks, const FollowedTreeStatus& tree, bool drawn) {
  using State = FollowedTreeStatus::State;
  const bool old = tree.state == State::followed && tree.age >= FollowedTreeStatus::old_after;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(tree.age).count();
  marks.tree_old = old || tree.state == State::unmatched || tree.state == State::removed;
  if (tree.state == State::unmatched)
    marks.tree.format("vessels do not match");
  else if (tree.state == State::looking)
    marks.tree.format("vessels not placed yet");
  else if (tree.state == State::removed && drawn) // where somebody had put it
    marks.tree.format("vessels as placed by hand");
  else if (old || tree.state == State::removed)
    marks.tree.format("{} {} s ago", drawn ? "vessels placed" : "no vessels: placed", seconds);
}

void compose_vessels(HudText& hud, const ViewState& view, const VesselStatus& vessels, bool flow) {
  const bool wanted = shows_tree(view) && view.vessel_opacity > 0;
  hud.vessels.flow = flow;
  if (wanted && vessels.traced)
    compose_traced(hud.vessels, *vessels.traced);
  if (wanted && vessels.followed)
    compose_followed(hud.vessels, *vessels.followed, vessels.state == VesselStatus::State::shown);
  hud.vessels.shown = wanted && vessels.state == VesselStatus::State::shown;
  if (!hud.vessels.shown)
    return;
  hud.vessels.registered = vessels.registered;
  if (vessels.registered && !vessels.traced)
    compose_registration(hud.vessels.registration, view, vessels);
  hud.vessels.colouring = view.vessel_colouring;
  // SWC leaves their types to any program: they are the heart's where all three are there.
  const auto& [others, rca, lad, lcx] = vessels.branches;
  if (rca && lad && lcx)
    hud.vessels.branches = {others, rca, lad, lcx};
  if (view.vessel_account)
    hud.vessels.account = vessels.account;
}

void compose_reduction(HudText& hud, const Status& status, const ShownPictures& shown) {
  FixedText<96>& reduced = hud.facts[2];
  const bool merged = status.vessels.account.merged > 0;
  std::string_view vessels;
  if (hud.vessels.shown && shown.vessels_left_out)
    vessels = merged ? "thinnest vessels merged or left out" : "thinnest vessels left out";
  else if (hud.vessels.shown && merged)
    vessels = "thinnest vessels merged";
  if (!status.reduced_quality) {
    reduced.format("{}", vessels);
    return;
  }
  reduced.format("quality reduced to {:.0f} %{}{}",
                 std::floor(std::clamp(*status.reduced_quality, 0.0F, 1.0F) * 100),
                 vessels.empty() ? "" : ", ", vessels);
}

std::string_view word_for(pipeline::BScanState state) {
  switch (state) {
  case pipeline::BScanState::missing: return "missing";
  case pipeline::BScanState::saturated: return "saturated";
  case pipeline::BScanState::seam: return "being renewed";
  case pipeline::BScanState::good: return "";
  }
  return "";
}

void say_flow(HudText& hud, const ViewState& view, const ShownPictures& shown) {
  const FlowShown& flow = shown.flow;
  if (!flow.shown)
    return;
  // What is wrong with a B-scan is graver.
  if (shown.b_scan == pipeline::BScanState::good && flow.b_scan != pipeline::FlowState::told)
    hud.b_scan.note.format("{} of {}, {}", view.b_scan + 1, shown.geometry.b_scans,
                           flow.b_scan == pipeline::FlowState::left_out ? "moved: no flow"
                                                                        : "no flow");
  if (flow.deepest_mm > 0)
    hud.en_face.deepest.format("{:g} mm", flow.deepest_mm);
  if (flow.in_scope && hud.liveness == Liveness::live)
    hud.scope.deepest = hud.en_face.deepest;
}

void compose_captions(HudText& hud, const ViewState& view, const Status& status,
                      const ShownPictures& shown) {
  hud.volume.title.format("Volume");
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
    say_flow(hud, view, shown);
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
    hud.scope.deepest = {};
  }
}

} // namespace

HudText compose_hud_text(const ViewState& view, const Status& status, const ShownPictures& shown) {
  HudText hud;
  hud.liveness = status.freshness.liveness;
  compose_vessels(hud, view, status.vessels, shown.flow.shown);
  compose_badges(hud, view, status, shown);
  hud.devices = status.devices;
  hud.device_count = std::min(status.device_count, Status::most_devices);
  compose_troubles(hud, status, shown.flow);
  compose_bar(hud, status);
  hud.figures_shown = view.figures != FiguresShown::none;
  if (view.figures == FiguresShown::timing && status.timing != nullptr) {
    hud.timing = status.timing;
    hud.timed_volume = status.timing->newest;
  }
  if (hud.figures_shown) // else nothing is drawn anew for them
    compose_figures(hud, view, status, shown.flow);
  compose_reduction(hud, status, shown);
  hud.ends = ends_of(status.orientation.on_eye, status.eye);
  if (!hud.ends.said())
    hud.labels = status.orientation.labels;
  compose_captions(hud, view, status, shown);
  hud.window_changing = status.now < view.echo.until && changes_window(view.echo.action);
  hud.echo = compose_echo(view, status.now, shown.geometry);
  if (view.legend_visible)
    hud.legend = view.legend_of_keys ? status.key_legend : status.legend;
  hud.selected = view.selected;
  if (hud.legend != nullptr || hud.notice.view().size() > one_page)
    hud.page = status.now.time_since_epoch() / page_time;
  return hud;
}

} // namespace octascope::ui
