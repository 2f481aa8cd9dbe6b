#include "firmware-host/run/live_configuration.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware-host/configuration/kept/configuration_changes.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;
using ui::ConfigurationState;

constexpr hal::Duration read_anew_shown_for = 4s;
constexpr hal::Duration settings_broken_shown_for = 10s;

bool names_controls(const Configuration& configuration) {
  return configuration.control_profile || configuration.control_file;
}

} // namespace

LiveConfiguration::LiveConfiguration(const ChosenConfiguration& chosen, const RunOptions& options,
                                     const std::optional<std::filesystem::path>& state_folder,
                                     hal::Clock& clock, pipeline::FaultLog& faults)
    : chosen_{chosen}, started_{chosen.configuration}, used_{chosen.configuration},
      options_{options}, clock_{clock}, faults_{faults}, standing_{configuration_notice(chosen)} {
  if (chosen_.state != ConfigurationState::own)
    faults_.add(pipeline::Fault::configuration_refused, chosen_.refusal, clock_.now());
  if (started_.calibration)
    if (auto read = ConfigurationBundle::gather_calibration(*started_.calibration))
      started_calibration_ = std::move(*read);
  if (!state_folder)
    return;
  settings_.emplace(*state_folder / "settings.toml", clock_, faults_);
  last_good_.emplace(*state_folder, clock_, faults_);
  if (chosen_.state == ConfigurationState::own && chosen_.wanted)
    last_good_->begin(*chosen_.wanted);
}

void LiveConfiguration::configure(RenderLoopSetup& setup) {
  ui::ViewState& view = setup.view;
  if (used_.window) {
    setup.window_from_first_volume = false;
    view.window_offset_db = used_.window->offset_db;
    view.window_size_db = used_.window->size_db;
  }
  setup.transfers = used_.look.transfers;
  view.transfer = used_.look.transfer;
  view.colour_map = used_.look.colour_map;
  view.technique = used_.look.technique;
  view.opacity = used_.look.opacity;
  view.rolling = used_.look.rolling || options_.rolling;
  setup.orientation = used_.orientation;
  if (!settings_)
    return;
  const auto restored = settings_->restore({view, !used_.window, setup.transfers});
  if (restored) {
    setup.restored_view = restored->view;
    setup.restored_view->rolling |= options_.rolling;
    setup.window_restored = restored->window;
  } else if (settings_->was_broken()) {
    say("Pedal's settings unreadable: as configured", settings_broken_shown_for);
  }
}

void LiveConfiguration::follow(std::unique_ptr<ConfigurationWatch> watch) {
  watch_ = std::move(watch);
  if (!chosen_.wanted)
    return;
  reload_.emplace(*chosen_.wanted, options_);
  for (const auto& file : {used_.calibration, used_.control_file})
    if (file)
      watch_->watch_too(*file);
}

void LiveConfiguration::lead_with(ui::ControlProfile profile, RenderLoop& loop) {
  if (!names_controls(used_))
    loop.change_controls(profile);
  device_profile_ = std::move(profile);
}

ConfiguredView LiveConfiguration::configured_view(const RenderLoop& loop) const {
  return {loop.actions().initial(), !used_.window, used_.look.transfers};
}

void LiveConfiguration::advance(RenderLoop& loop) {
  const hal::TimePoint now = clock_.now();
  if (said_ && now >= said_until_)
    said_.reset();
  if (watch_ && watch_->changed() && reload_)
    reload_->ask(now);
  if (auto read = reload_ ? reload_->take(now) : std::nullopt) {
    if (*read)
      take_over(std::move(**read), loop);
    else
      refuse(read->error().message);
  }
  if (last_good_)
    last_good_->advance(loop.statistics().volumes_displayed > displayed_before_);
  if (settings_)
    settings_->note(configured_view(loop), loop.actions().state());
}

void LiveConfiguration::finish(RenderLoop& loop) {
  if (last_good_)
    last_good_->finish(loop.statistics().volumes_displayed > displayed_before_);
  if (settings_)
    settings_->finish(configured_view(loop), loop.actions().state());
}

void LiveConfiguration::refuse(const std::string& reason) {
  faults_.add(pipeline::Fault::configuration_refused, reason, clock_.now());
  said_.reset();
  if (chosen_.state != ConfigurationState::own) {
    chosen_.refusal = reason;
    standing_ = configuration_notice(chosen_);
    return;
  }
  standing_ = "Not taken over: " + short_reason(reason, *chosen_.wanted);
}

std::vector<std::string> LiveConfiguration::waits_for_restart(const ReadConfiguration& read) const {
  auto sections = changes_for_a_restart(started_, read.configuration);
  if (started_.calibration == read.configuration.calibration &&
      started_calibration_ != read.calibration)
    sections.emplace_back("the calibration");
  return sections;
}

// What runs is another configuration than the file's: with its other sections, the look of the new
// one would be a mixture that nobody wrote.
void LiveConfiguration::take_over(ReadConfiguration read, RenderLoop& loop) {
  if (chosen_.state != ConfigurationState::own) {
    standing_ = "Configuration fixed: restart to use it";
    return;
  }
  const auto sections = waits_for_restart(read);
  change_live(read, loop);
  standing_ = sections.empty() ? std::string{}
                               : fmt::format("Restart to use {}", fmt::join(sections, ", "));
  if (!sections.empty())
    return;
  say("Configuration read anew", read_anew_shown_for);
  displayed_before_ = loop.statistics().volumes_displayed;
  if (last_good_)
    last_good_->begin(*chosen_.wanted);
}

void LiveConfiguration::change_live(ReadConfiguration& read, RenderLoop& loop) {
  ui::ViewActions& actions = loop.editable_actions();
  const ui::ViewState initial = with_changes(actions.initial(), used_, read.configuration);
  const ui::ViewState state = with_changes(actions.state(), used_, read.configuration);
  if (!same_transfers(used_.look.transfers, read.configuration.look.transfers))
    loop.change_transfers(read.configuration.look.transfers);
  actions.replace(initial, state);
  loop.change_veil(read.configuration.veil_after);
  loop.change_orientation(read.configuration.orientation);
  if (names_controls(read.configuration))
    loop.change_controls(std::move(read.controls));
  else if (names_controls(used_))
    loop.change_controls(device_profile_.value_or(std::move(read.controls)));
  used_ = std::move(read.configuration);
}

void LiveConfiguration::say(std::string words, hal::Duration shown_for) {
  said_ = std::move(words);
  said_until_ = clock_.now() + shown_for;
}

} // namespace octascope::firmware_host
