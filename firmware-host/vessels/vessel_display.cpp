#include "firmware-host/vessels/vessel_display.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/configuration/run_options.h"
#include "firmware-host/vessels/vessel_patient_check.h"
#include "firmware-host/vessels/vessel_place.h"
#include "pipeline/vessels/vectors.h"

namespace octascope::firmware_host {

using namespace std::chrono_literals;

namespace {

constexpr hal::Duration notice_duration = 15s;
constexpr int share_of_frame = 3; // the volume needs the larger part

const std::string nothing_to_say;

} // namespace

hal::Result<std::unique_ptr<VesselDisplay>>
make_vessel_display(const RunOptions& options, bool live, pipeline::PatientEye operated,
                    hal::Clock& clock, pipeline::FaultLog& faults, pipeline::Wakeup& news,
                    const pipeline::ThreadSetup& threads) {
  VesselDisplaySetup setup;
  if (options.registration) {
    HAL_TRY(auto loaded, pipeline::Registration::load(*options.registration));
    HAL_CHECK(check_vessel_patient(*options.registration, loaded.whose, operated));
    setup.registration = std::move(loaded);
  }
  setup.operated = std::move(operated);
  if (!options.vessels && !live)
    return std::unique_ptr<VesselDisplay>{};
  setup.file = options.vessels.value_or(std::filesystem::path{});
  setup.live = live;
  setup.threads = threads;
  setup.registration_file = options.registration;
  return std::make_unique<VesselDisplay>(std::move(setup), clock, faults, news);
}

VesselDisplay::VesselDisplay(VesselDisplaySetup setup, hal::Clock& clock,
                             pipeline::FaultLog& faults, pipeline::Wakeup& news)
    : setup_{std::move(setup)}, clock_{clock}, faults_{faults}, news_{news} {
  if (!setup_.file.empty())
    loader_.emplace(setup_.file, news);
  if (setup_.live)
    live_.emplace(clock, news, setup_.threads);
}

// A traced tree is in the volume's frame.
ui::PlacedVessels VesselDisplay::placed() const {
  if (!loaded_)
    return live_ && live_->drawn() != nullptr
               ? place_vessels(*live_->drawn()->packed, pipeline::RigidTransform{})
               : ui::PlacedVessels{};
  const auto place = drawn_place();
  if (live_ && !place)
    return {};
  return place_vessels(*loaded_, place);
}

// What flows says it best, then what somebody said.
std::optional<pipeline::RigidTransform> VesselDisplay::drawn_place() const {
  if (is_followed() && place_age_ < ui::FollowedTreeStatus::removed_after)
    return followed_->place.volume_from_tree;
  if (setup_.registration)
    return setup_.registration->volume_from_tree;
  return std::nullopt;
}

hal::Result<> VesselDisplay::show(ui::Renderer& renderer) const {
  return renderer.show_vessels(placed(), clock_);
}

hal::Result<> VesselDisplay::show_again(ui::Renderer& renderer) {
  return status_.state == ui::VesselStatus::State::shown ? show(renderer) : hal::Result<>{};
}

// What is registered to this eye by hand is this eye's.
pipeline::PatientEye VesselDisplay::whose_vessels() const {
  const pipeline::PatientEye before =
      setup_.registration ? setup_.registration->whose : pipeline::PatientEye{};
  return before.said() ? before : setup_.operated;
}

void VesselDisplay::say(std::string notice) {
  notice_ = std::move(notice);
  notice_until_ = clock_.now() + notice_duration;
}

const std::string& VesselDisplay::notice(hal::TimePoint now) const {
  return now < notice_until_ ? notice_ : nothing_to_say;
}

void VesselDisplay::advance(ui::Renderer* renderer, ui::ViewActions& actions,
                            const pipeline::Volume* shown) {
  if (loader_)
    take_loaded(renderer, actions);
  if (live_)
    show_live(renderer, actions, shown);
  take_written(renderer, actions);
  if (status_.state == ui::VesselStatus::State::loading)
    status_.progress = loader_->progress();
  describe_place();
}

// Those from a file are followed by traced ones.
void VesselDisplay::trace(const pipeline::Volume* shown, const ui::ViewState& view) {
  if (live_ && shown != nullptr)
    live_->trace(*shown, ui::shows_tree(view) || loaded_.has_value());
}

void VesselDisplay::describe_place() {
  using Followed = ui::FollowedTreeStatus;
  status_.registered = drawn_place().has_value() || status_.traced;
  status_.residual_mm = std::nullopt;
  if (setup_.registration)
    status_.residual_mm = setup_.registration->provenance.residual_mm;
  if (!follower_)
    return;
  status_.followed.reset();
  if (!followed_) {
    if (!setup_.registration) // else it is drawn where somebody put it
      status_.followed.emplace();
    return;
  }
  status_.followed.emplace();
  const pipeline::FollowedPlace& place = followed_->place;
  if (is_followed() && place_age_ < Followed::removed_after) {
    status_.followed = {Followed::State::followed, place.overlap, place_age_};
    status_.residual_mm = place.residual_mm;
    status_.registered = place_age_ < Followed::unregistered_after;
  } else if (is_followed()) {
    status_.followed = {Followed::State::removed, 0, place_age_};
  } else if (!place.refusal.empty()) {
    status_.followed = {Followed::State::unmatched, 0, {}};
  }
}

// By the trees that are traced in the volumes, and by what the volumes move. Of a frozen picture the age is the
// one then.
void VesselDisplay::follow(ui::Renderer* renderer, const pipeline::Volume* shown, bool frozen) {
  using State = ui::VesselStatus::State;
  if (!follower_)
    follower_.emplace(*loaded_, drawn_place(), clock_, news_, setup_.threads);
  follower_->offer(live_->newest());
  if (shown != nullptr && shown->has_flow())
    follower_->offer(*shown);
  const auto before = drawn_place();
  if (auto found = follower_->take())
    take_place(std::move(*found));
  const hal::TimePoint now = frozen && shown != nullptr ? shown->metadata.last_line : clock_.now();
  if (is_followed())
    place_age_ = std::max(now - followed_->registered_in, hal::Duration{});
  status_.state = drawn_place() ? State::shown : State::none;
  if (before != drawn_place() && renderer != nullptr)
    static_cast<void>(show(*renderer)); // that it can be shown, it has proved
}

void VesselDisplay::take_place(FollowedVessels found) {
  const bool was_known = is_followed();
  const bool was_refused = followed_ && !followed_->place.refusal.empty();
  followed_ = std::move(found);
  if (is_followed() != was_known || (!was_known && followed_->place.refusal.empty() == was_refused))
    say_place(was_known);
}

void VesselDisplay::say_place(bool was_known) {
  const pipeline::FollowedPlace& place = followed_->place;
  if (!place.volume_from_tree) {
    if (!place.refusal.empty())
      say(fmt::format("Vessels {}: {}", was_known ? "no longer match" : "do not match",
                      place.refusal));
    return;
  }
  std::string found = fmt::format("Vessels registered to what flows: {:.0f} % overlap, residual "
                                  "{:.0f} µm",
                                  place.overlap * 100, place.residual_mm * 1e3);
  if (setup_.registration) {
    const ui::PlacedVessels tree = place_vessels(*loaded_, std::nullopt);
    const pipeline::Point off =
        pipeline::difference(place.volume_from_tree->apply(tree.centre_mm),
                             setup_.registration->volume_from_tree.apply(tree.centre_mm));
    found += fmt::format(", {:.2f} mm from where they were registered", pipeline::length(off));
  }
  say(std::move(found));
}

// Beside a tree from a file, which is drawn in its stead, it only serves to tell where that one lies.
void VesselDisplay::show_live(ui::Renderer* renderer, ui::ViewActions& actions,
                              const pipeline::Volume* shown) {
  using State = ui::VesselStatus::State;
  const bool changed = live_->advance(shown, actions.state().frozen);
  take_kept_tree();
  if (loaded_ && status_.state != State::failed)
    follow(renderer, shown, actions.state().frozen);
  if (loader_ || status_.state == State::failed || !live_->status())
    return;
  if (!status_.traced)
    actions.set_vessels_traced();
  status_.traced = live_->status();
  if (!changed)
    return;
  const auto drawn = renderer != nullptr ? show(*renderer) : hal::Result<>{};
  status_.state = live_->drawn() != nullptr ? State::shown : State::none;
  if (drawn)
    return;
  status_.state = State::failed;
  status_.traced.reset();
  faults_.add(pipeline::Fault::vessels_not_shown, drawn.error().message, clock_.now());
  say(fmt::format("No vessels: {}", drawn.error().message));
}

void VesselDisplay::keep_tree(const std::filesystem::path& folder) {
  if (live_ && !loader_)
    live_->keep(folder);
}

void VesselDisplay::take_kept_tree() {
  const auto kept = live_->take_kept();
  if (!kept)
    return;
  if (*kept) {
    say(fmt::format("Vessel tree kept in {}", (*kept)->filename().string()));
    return;
  }
  faults_.add(pipeline::Fault::picture_not_kept, kept->error().message, clock_.now());
  say(fmt::format("Vessel tree not kept: {}", kept->error().message));
}

std::optional<LiveTreeThread::Counters> VesselDisplay::traced() const {
  return live_ ? std::optional{live_->counters()} : std::nullopt;
}

void VesselDisplay::take_loaded(ui::Renderer* renderer, ui::ViewActions& actions) {
  using State = ui::VesselStatus::State;
  auto result = loader_->take();
  if (!result) {
    if (status_.state == State::none && !loaded_)
      status_.state = State::loading;
    return;
  }
  hal::Result<> shown;
  if (*result) {
    loaded_.emplace(std::move(**result));
    for (const pipeline::VesselCluster& cluster : loaded_->clusters().clusters)
      status_.branches[static_cast<std::size_t>(cluster.branch)] = true;
    shown = renderer != nullptr ? show(*renderer) : hal::Result<>{};
  } else {
    shown = tl::make_unexpected(result->error());
  }
  status_.state = !shown ? State::failed : live_ && !drawn_place() ? State::none : State::shown;
  actions.set_vessels_loaded(shown.has_value());
  if (shown && setup_.registration && setup_.registration->whose.said() && !setup_.operated.said())
    say(fmt::format("Vessels of {}", in_words(setup_.registration->whose)));
  if (!shown) {
    faults_.add(pipeline::Fault::vessels_not_shown, shown.error().message, clock_.now());
    say(fmt::format("No vessels: {}", shown.error().message));
  }
}

// What is in the file is where the tree is registered from now on; unless it was moved once more
// meanwhile, or could not be written: then it stays nudged, and can be kept again.
void VesselDisplay::take_written(ui::Renderer* renderer, ui::ViewActions& actions) {
  const auto written = keeper_.take();
  if (!written)
    return;
  if (!*written) {
    faults_.add(pipeline::Fault::registration_not_kept, written->error().message, clock_.now());
    actions.tell(ui::Action::keep_registration, "not kept", clock_.now());
    say(fmt::format("Vessels' place not kept: {}", written->error().message));
    return;
  }
  actions.tell(ui::Action::keep_registration, "kept", clock_.now());
  say(fmt::format("Vessels' place kept in {}", (*written)->filename().string()));
  if (actions.state().vessel_nudge != kept_nudge_)
    return;
  setup_.registration_file = **written;
  setup_.registration = pipeline::Registration{kept_, whose_vessels(), {}};
  actions.forget_nudge();
  if (follower_)
    follower_->begin_at(kept_);
  followed_.reset();
  if (renderer != nullptr)
    static_cast<void>(show(*renderer)); // that it can be shown, it has proved
}

void VesselDisplay::keep_registration(const pipeline::VolumeGeometry& geometry,
                                      ui::ViewActions& actions) {
  if (!loaded_ || status_.state != ui::VesselStatus::State::shown) {
    actions.tell(ui::Action::keep_registration, "no loaded vessels are shown", clock_.now());
    return;
  }
  const ui::VesselNudge nudge = actions.state().vessel_nudge;
  const pipeline::RigidTransform place = volume_from_tree(placed(), nudge, geometry);
  const std::string before =
      setup_.registration_file ? setup_.registration_file->filename().string() : "not registered";
  if (!keeper_.keep(place, whose_vessels(),
                    fmt::format("{}, before: {}", setup_.file.filename().string(), before))) {
    actions.tell(ui::Action::keep_registration, "one is being written", clock_.now());
    return;
  }
  kept_ = place;
  kept_nudge_ = nudge;
}

float VesselDisplay::detail_px(hal::TimePoint now, bool moved) {
  if (moved)
    moved_at_ = now;
  at_rest_ = !moved_at_ || now - *moved_at_ >= ui::Governor::rest_after;
  return governor_.detail_px(at_rest_);
}

void VesselDisplay::note(const ui::Renderer::VesselReport& report, hal::Duration budget) {
  status_.account = report.account;
  governor_.set_budget(budget / share_of_frame);
  if (!at_rest_ && report.cost > hal::Duration{})
    governor_.note(report.cost);
}

} // namespace octascope::firmware_host
