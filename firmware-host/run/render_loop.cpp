#include "firmware-host/run/render_loop.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "pipeline/threads/hot_path.h"
#include "ui/controls/simulated_control.h"
#include "ui/transfer/histogram.h"

namespace octascope::firmware_host {

namespace {

// A picture that does not change is shown again so often: that it is still true has to be proved.
constexpr std::chrono::milliseconds longest_rest{900};

bool brings_volumes(ui::Liveness liveness) {
  return liveness == ui::Liveness::live || liveness == ui::Liveness::replayed;
}

} // namespace

RenderLoop::RenderLoop(const RenderLoopParts& parts, RenderLoopSetup setup)
    : parts_(parts), setup_(std::move(setup)), legend_(ui::make_legend(setup_.controls)),
      key_legend_(ui::make_key_legend()),
      controller_(setup_.view, setup_.geometry, setup_.controls, setup_.transfers.names()),
      governor_({}) {
  if (setup_.restored_view)
    controller_.actions().replace(controller_.actions().initial(), *setup_.restored_view);
  status_writer_.orient(setup_.orientation);
  status_writer_.tell(setup_.host);
}

RenderLoop::~RenderLoop() {
  renderer_.reset(); // before its context
  parts_.display.close();
}

void RenderLoop::change_controls(ui::ControlProfile profile) {
  legend_ = ui::make_legend(profile);
  controller_.change_profile(std::move(profile));
}

// Every picture that the renderer holds was made with the old ones.
void RenderLoop::change_transfers(ui::TransferSet transfers) {
  setup_.transfers = std::move(transfers);
  controller_.actions().set_choices(setup_.transfers.names());
  if (!renderer_)
    return;
  renderer_.reset();
  auto renderer = ui::Renderer::create(setup_.transfers, parts_.threads);
  if (!renderer) {
    lose_display(renderer.error());
    return;
  }
  renderer_ = std::move(*renderer);
  levels_of_ = 0;
  if (const auto shown = show_again(); !shown)
    lose_display(shown.error());
}

// A frame that begins late takes in what came meanwhile.
void RenderLoop::wait_to_begin() {
  const hal::TimePoint now = parts_.clock.now();
  parts_.clock.sleep_until(late_start_.begin(now, next_refresh(), parts_.display.refresh_period()));
  turn_began_ = parts_.clock.now();
}

std::optional<hal::TimePoint> RenderLoop::next_refresh() const {
  return renderer_ ? parts_.display.next_refresh() : std::nullopt;
}

bool RenderLoop::turn() {
  wait_to_begin();
  const bool go_on = handle_input();
  take_volume();
  take_scope_picture();
  if (parts_.vessels != nullptr)
    parts_.vessels->advance(renderer_.get(), controller_.actions(), volume_.whole());
  update_status();
  if (display_ready()) {
    draw_if_changed();
    report_flow_refusal();
    choose_ray_backend();
  }
  if (parts_.vessels != nullptr)
    parts_.vessels->trace(volume_.whole(), controller_.state());
  if (renderer_ && !volume_undisplayed_)
    volume_.bring_ahead(*renderer_, controller_.state());
  const hal::TimePoint next = late_start_.next_look(turn_began_, parts_.clock.now(), next_refresh(),
                                                    parts_.display.refresh_period());
  // At once when something came meanwhile; a long press is due when it is.
  parts_.news.wait_until(parts_.clock, std::min(next, controller_.next_deadline().value_or(next)));
  return go_on;
}

bool RenderLoop::casts_rays() const {
  const ui::Technique technique = controller_.state().technique;
  return software_ && (technique == ui::Technique::rays || technique == ui::Technique::maximum ||
                       technique == ui::Technique::shaded);
}

// Of a rolling volume's picture, at rest (ui/volume/ray_cast_picture.h).
bool RenderLoop::draws_parts() const {
  const ui::ViewState& view = controller_.state();
  return volume_.rolls() && casts_rays() && view.technique != ui::Technique::shaded &&
         (parts_.vessels == nullptr || !ui::shows_tree(view));
}

ui::FrameBudget RenderLoop::frame_budget() const {
  return ui::frame_budget(parts_.display.refresh_period(),
                          {.software = software_,
                           .rolling = volume_.rolls(),
                           .in_parts = draws_parts(),
                           .waits_for_refresh = next_refresh().has_value()});
}

// The frame that first says that the picture is STALE or FROZEN is drawn no finer than those before
// it: the badge does not wait for a picture that takes its time. Nor is one that came too late, where
// others follow it: drawn finely, it would make the next one later still.
ui::DrawQuality RenderLoop::choose_quality() {
  const ui::ViewState& view = controller_.state();
  const bool moved = drawn_view_ && !ui::same_sight(*drawn_view_, view);
  governor_.set_budget(frame_budget());
  ui::DrawQuality quality =
      governor_.choose({.now = status().now,
                        .technique = view.technique,
                        .moved = moved,
                        .live = brings_volumes(status().freshness.liveness) ||
                                brings_volumes(drawn_liveness_) || volume_undisplayed_,
                        .cast = casts_rays()});
  quality.rays = rays_;
  if (parts_.vessels != nullptr) {
    quality.vessel_detail_px = parts_.vessels->detail_px(status().now, moved);
    quality.vessels_occluded = parts_.vessels->occluded();
  }
  return quality;
}

// While the first volume is awaited: later, it would take its time from the picture.
void RenderLoop::choose_ray_backend() {
  if (rays_tried_ || !renderer_ || statistics_.frames_drawn == 0 || volume_.whole() != nullptr)
    return;
  rays_tried_ = true;
  if (const auto trial = ui::try_ray_backends(parts_.clock)) {
    statistics_.rays = *trial;
    rays_ = trial->faster();
  }
}

// How often each level occurs, for the histogram that is shown while the window changes.
void RenderLoop::show_levels() {
  const ui::ViewState& view = controller_.state();
  if (volume_.whole() == nullptr || status().now >= view.echo.until ||
      !ui::changes_window(view.echo.action) || levels_of_ == volume_.whole()->metadata.index)
    return;
  renderer_->show_levels(ui::make_level_histogram(*volume_.whole()).shares());
  levels_of_ = volume_.whole()->metadata.index;
}

bool RenderLoop::handle_input() {
  bool quit = false;
  // One after the other: what comes next may undo what was to be kept.
  const auto act = [&](const ui::ControlRequests& requests) {
    answer(requests);
    quit = quit || requests.quit;
  };
  const ui::ViewState before = controller_.state();
  std::optional<hal::TimePoint> oldest;
  const auto seen = [&](hal::TimePoint time) { oldest = std::min(oldest.value_or(time), time); };
  std::array<hal::DisplayEvent, 32> events;
  if (renderer_) {
    for (const hal::DisplayEvent& event :
         std::span{events}.first(parts_.display.poll_events(events))) {
      act(controller_.handle(event));
      seen(event.time);
      if (const auto control = ui::simulated_control(event); control && parts_.simulated_control)
        parts_.simulated_control(*control);
    }
  }
  // What is asked for after a picture is not in it: it waits for the next turn.
  bool keeps = false;
  while (const auto event = keeps ? std::nullopt : parts_.controls.take()) {
    const ui::ControlRequests requests = controller_.handle(*event);
    act(requests);
    seen(event->time);
    keeps = requests.snapshot;
  }
  if (keeps)
    parts_.news.post(); // there may be more
  act(controller_.advance(parts_.clock.now()));
  if (!undisplayed_control_ && oldest && !(before == controller_.state()))
    undisplayed_control_ = oldest;
  return !quit;
}

void RenderLoop::answer(const ui::ControlRequests& requests) {
  picture_wanted_ = picture_wanted_ || requests.snapshot;
  if (requests.auto_window)
    find_window();
  if (requests.keep_registration && volume_.whole() == nullptr)
    controller_.actions().tell(ui::Action::keep_registration, "not yet: no volume",
                               parts_.clock.now());
  else if (requests.keep_registration && parts_.vessels != nullptr)
    parts_.vessels->keep_registration(volume_.whole()->geometry, controller_.actions());
  if (requests.record)
    controller_.actions().tell(ui::Action::record,
                               status().replay ? "not while a recording is replayed"
                               : parts_.record ? parts_.record()
                                               : "not of this picture",
                               parts_.clock.now());
}

void RenderLoop::find_window() {
  const auto window =
      volume_.whole() != nullptr ? ui::suggest_window(*volume_.whole()) : std::nullopt;
  if (window)
    controller_.actions().show_window(window->offset_db, window->size_db, parts_.clock.now());
  else
    controller_.actions().tell(ui::Action::auto_window, "no volume yet", parts_.clock.now());
}

// As the display shows it; that it was kept is said afterwards.
void RenderLoop::keep_picture() {
  const bool kept =
      parts_.keep_picture(renderer_->read_back(parts_.display.width(), parts_.display.height()));
  controller_.actions().tell(ui::Action::snapshot,
                             kept ? "kept" : "not kept: others are being written",
                             parts_.clock.now());
  picture_wanted_ = false;
}

void RenderLoop::take_volume() {
  const ui::ViewState& view = controller_.state();
  if (!renderer_) {
    volume_.keep(view);
    return;
  }
  const pipeline::Volume* newest = volume_.take(view);
  if (newest != nullptr) {
    ++statistics_.volumes_taken;
    volume_undisplayed_ = false; // of the one before: if it was, it is lost
  }
  if (!volume_.has_news())
    return;
  const hal::TimePoint begin = parts_.clock.now();
  renderer_->expect(view);
  if (const auto shown = volume_.show(*renderer_, view); !shown)
    parts_.faults.add(pipeline::Device::display, shown.error(), begin);
  else if (newest != nullptr)
    note_taken(*newest, begin);
}

void RenderLoop::note_taken(const pipeline::Volume& newest, hal::TimePoint begin) {
  showing_ = {.taken = begin, .uploaded = parts_.clock.now(), .drawn = {}, .flipped = {}};
  statistics_.upload.add(showing_.uploaded - showing_.taken);
  if (setup_.window_from_first_volume && !status_writer_.has_volume()) {
    if (const auto window = ui::suggest_window(newest))
      set_first_window(*window);
  }
  controller_.actions().set_flow_there(newest.has_flow());
  volume_undisplayed_ = true;
  undisplayed_last_line_ = newest.metadata.last_line;
  status_writer_.show(newest);
}

void RenderLoop::set_first_window(const ui::DisplayWindow& window) {
  ui::ViewActions& actions = controller_.actions();
  const ui::ViewState state = actions.state();
  actions.set_window(window.offset_db, window.size_db);
  if (setup_.window_restored)
    actions.replace(actions.initial(), state);
}

void RenderLoop::take_scope_picture() {
  if (!renderer_ || parts_.scope == nullptr)
    return;
  if (const hal::ScopeFrame* picture = parts_.scope->take_newest()) {
    scope_picture_ = picture;
    show_scope_picture();
  }
}

void RenderLoop::show_scope_picture() {
  if (const auto shown = renderer_->show_scope_picture(*scope_picture_, setup_.scan_field); !shown)
    parts_.faults.add(pipeline::Device::scope_camera, shown.error(), parts_.clock.now());
}

RunCounters RenderLoop::counters() const {
  RunCounters counters{.volumes = parts_.volumes.counters(),
                       .displayed = statistics_.volumes_displayed,
                       .undisplayed = statistics_.volumes_taken - statistics_.volumes_displayed,
                       .frames_drawn = statistics_.frames_drawn,
                       .frames_missed = statistics_.frames_missed,
                       .hot_path_allocations = pipeline::HotPath::allocations(),
                       .rates = status_writer_.rates(),
                       .latency = statistics_.latency.summary()};
  if (parts_.acquisition != nullptr)
    counters.lines =
        parts_.acquisition->counters().frames * static_cast<std::uint64_t>(setup_.lines_per_frame);
  return counters;
}

RunCounters RenderLoop::final_counters(hal::Duration lasted) const {
  RunCounters all = counters();
  all.volumes.skipped += parts_.volumes.has_newer() ? 1U : 0U;
  const auto per_s = [lasted](std::uint64_t count) {
    return static_cast<double>(count) / hal::to_seconds(lasted);
  };
  all.rates = {per_s(all.lines), per_s(all.volumes.published + all.volumes.passed_over),
               per_s(all.displayed), per_s(all.frames_drawn)};
  return all;
}

void RenderLoop::update_status() {
  status_writer_.count(counters(), parts_.clock.now());
  const ui::ViewState& view = controller_.state();
  status_writer_.judge(setup_.freshness,
                       view.frozen ? std::optional{view.frozen_since} : std::nullopt);
  status_writer_.roll(view.rolling, volume_.rolls(), volume_.seam());
  if (parts_.vessels != nullptr)
    status_writer_.show_vessels(parts_.vessels->status());
}

// After a frame that is begun now. Outputs without a refresh that is known hold it for whole periods, too.
hal::TimePoint RenderLoop::free_again(hal::TimePoint now) const {
  const auto refresh = next_refresh();
  return ui::LateStart::seen(now + governor_.longest_fixed_cost(), refresh ? refresh : last_free_,
                             parts_.display.refresh_period());
}

// A frame that shows nothing new of the volume, such as one for the microscope camera's picture, lets the
// next volume go first where that comes before the renderer would be free again; if it is later than the last one
// was, no more.
bool RenderLoop::awaits_volume() const {
  constexpr std::chrono::milliseconds patience{3}, longest_making{20};
  const pipeline::Volume* const last = volume_.whole();
  if (last == nullptr || volume_.rolls() || volume_undisplayed_ || undisplayed_control_ ||
      status().freshness.liveness != ui::Liveness::live)
    return false;
  const hal::TimePoint due =
      std::min(last->metadata.published, last->metadata.last_line + longest_making) +
      setup_.freshness.volume_period;
  const hal::TimePoint now = parts_.clock.now();
  return free_again(now) > due && now < due + patience;
}

// It takes longer than others: a frame that nobody waits for is taken for it, if one comes in time.
bool RenderLoop::is_to_be_whole() const {
  if (!drawn_whole_)
    return true;
  const hal::Duration age = status().now - *drawn_whole_;
  const bool is_awaited = volume_.rolls() || volume_undisplayed_ || undisplayed_control_;
  return age >= longest_rest ||
         (age >= longest_rest * 2 / 3 && !is_awaited && !volume_comes_soon());
}

// Within half of the time that there is between two.
bool RenderLoop::volume_comes_soon() const {
  const pipeline::Volume* const last = volume_.whole();
  return last != nullptr && status().freshness.liveness == ui::Liveness::live &&
         parts_.clock.now() > last->metadata.last_line + setup_.freshness.volume_period / 2;
}

void RenderLoop::draw_if_changed() {
  const ui::ViewState& view = controller_.state();
  quality_ = choose_quality();
  status_writer_.reduce_quality(ui::visible_reduction(quality_));
  show_levels();
  hal::Display& display = parts_.display;
  const bool rested = presented_ && status().now - *presented_ >= longest_rest;
  if (!picture_wanted_ && !rested &&
      (awaits_volume() ||
       !renderer_->needs_redraw(view, status(), display.width(), display.height(), quality_)))
    return;
  const hal::TimePoint begin = parts_.clock.now();
  if (const auto complete = volume_.complete(*renderer_, view, quality_); !complete) {
    lose_display(complete.error());
    return;
  }
  // What it costs to bring a volume is not that of drawing it: no other quality would change it.
  renderer_->finish();
  const hal::TimePoint brought = parts_.clock.now();
  // A picture that is drawn in parts is drawn as a whole as often: which proves that all of it is true,
  // not that it was.
  hal::BackBuffer buffer = display.back_buffer();
  if (is_to_be_whole()) {
    buffer.holds = 0;
    drawn_whole_ = status().now;
  }
  if (const auto drawn =
          renderer_->draw(view, status(), display.width(), display.height(), quality_, buffer);
      !drawn) {
    lose_display(drawn.error());
    return;
  }
  renderer_->finish();
  const auto vessels = renderer_->vessel_report();
  governor_.note(parts_.clock.now() - brought - vessels.cost, renderer_->drew_volume());
  if (parts_.vessels != nullptr)
    parts_.vessels->note(vessels, std::max(frame_budget().moving, frame_budget().resting));
  drawn_view_ = view;
  drawn_liveness_ = status().freshness.liveness;
  if (picture_wanted_) // before the flip: afterwards the frame buffer is another one
    keep_picture();
  showing_.drawn = parts_.clock.now();
  if (undisplayed_last_line_ || volume_.rolls())
    volume_.note_drawn();
  const auto flip = display.present();
  last_free_ = parts_.clock.now();
  if (!flip)
    lose_display(flip.error());
  else
    flip_done(*flip, begin);
}

void RenderLoop::flip_done(const hal::Flip& flip, hal::TimePoint begin) {
  presented_ = flip.completed;
  if (flip.sequence == last_flip_) // another console is in front: nobody saw it
    return;
  late_start_.note(flip.submitted - turn_began_, flip.completed);
  last_flip_ = flip.sequence;
  prove_picture(flip);
  const hal::Duration took = flip.completed - begin;
  ++statistics_.frames_drawn;
  statistics_.draw.add(took);
  if (renderer_->drew_volume())
    statistics_.quality.add(controller_.state().technique, quality_);
  statistics_.frames_missed +=
      static_cast<std::uint64_t>(std::max<std::int64_t>(took / parts_.display.refresh_period(), 0));
  volume_.flipped(flip.completed);
  if (undisplayed_control_) {
    statistics_.control.add(flip.completed - *undisplayed_control_);
    undisplayed_control_.reset();
  }
  if (undisplayed_last_line_) {
    if (!statistics_.first_picture)
      statistics_.first_picture = flip.completed;
    statistics_.latency.add(flip.completed - *undisplayed_last_line_);
    showing_.flipped = flip.completed;
    note_passage();
    undisplayed_last_line_.reset();
  }
  // Also one that a lost display showed only when it was back; that delay is no latency of ours.
  if (std::exchange(volume_undisplayed_, false))
    ++statistics_.volumes_displayed;
}

// One that is replayed has come no such way.
void RenderLoop::note_passage() {
  if (volume_.whole()->work.empty())
    return;
  const auto lengths = stages_of(volume_.whole()->metadata, showing_);
  for (std::size_t i = 0; i < stage_count; ++i)
    statistics_.stages[i].add(lengths[i]);
  timing_.add(*volume_.whole(), showing_);
  if (parts_.trace != nullptr)
    parts_.trace->add(*volume_.whole(), showing_);
}

// What the frame says was judged in this turn, so it is true, unless drawing and showing it took so
// long that the picture would have had to be covered meanwhile.
void RenderLoop::prove_picture(const hal::Flip& flip) {
  if (parts_.proof != nullptr && flip.completed - status().now <= setup_.freshness.veil_after)
    parts_.proof->shown(volume_.whole() != nullptr);
}

std::optional<pipeline::Image> RenderLoop::picture() {
  if (!renderer_)
    return std::nullopt;
  // As it was shown: of a display that draws slowly, a live picture is STALE when we are back here.
  const int width = parts_.display.width();
  const int height = parts_.display.height();
  if (!volume_.complete(*renderer_, controller_.state(), quality_) ||
      !renderer_->draw(controller_.state(), status(), width, height, quality_))
    return std::nullopt;
  return renderer_->read_back(width, height);
}

} // namespace octascope::firmware_host
