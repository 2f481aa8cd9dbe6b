#include "firmware-host/vessels/live_tree_display.h"

#include <utility>

#include "firmware-host/outputs/dated_file.h"
#include "pipeline/vessels/files/swc_writer.h"

namespace octascope::firmware_host {

namespace {

using State = ui::TracedTreeStatus::State;

// On the display, where the finding has to do: how it comes about follows after a colon.
ui::TracedTreeStatus status_of(const LiveTree& tree) {
  ui::TracedTreeStatus status;
  status.vessels = tree.vessels;
  status.length_mm = tree.length_mm;
  status.refusal = tree.refusal.substr(0, tree.refusal.find(':'));
  return status;
}

State state_of(const LiveTree& tree, hal::Duration age) {
  if (age >= ui::TracedTreeStatus::removed_after)
    return State::removed;
  return tree.refusal.empty() ? State::shown : State::refused;
}

} // namespace

// A tree makes a picture of its own, which takes a while. In the picture of a new volume that would be
// late, and just before one it would make that wait: a tree's is the one after it.
bool LiveTreeDisplay::may_take(const pipeline::Volume* shown) {
  const hal::TimePoint now = clock_.now();
  const auto of = shown != nullptr ? std::optional{shown->metadata.last_line} : std::nullopt;
  const bool is_new = std::exchange(shown_last_, of) != of;
  if (is_new)
    volume_came_ = now;
  return std::exchange(was_new_, is_new) || now - volume_came_ >= longest_wait;
}

bool LiveTreeDisplay::advance(const pipeline::Volume* shown, bool frozen) {
  before_ = nullptr;
  if (may_take(shown))
    if (auto found = thread_.take()) {
      newest_ = std::move(found);
      status_ = status_of(*newest_);
    }
  if (newest_ == nullptr)
    return false;
  const hal::TimePoint now = frozen && shown != nullptr ? shown->metadata.last_line : clock_.now();
  status_->age = std::max(now - newest_->of_volume, hal::Duration{});
  status_->state = state_of(*newest_, status_->age);
  const auto& wanted = status_->state == State::shown ? newest_ : nullptr;
  if (drawn_ == wanted)
    return false;
  before_ = std::exchange(drawn_, wanted);
  return true;
}

void LiveTreeDisplay::keep(const std::filesystem::path& folder) {
  if (drawn_ == nullptr)
    return;
  writing_.start(
      [tree = drawn_,
       file = free_dated_name(folder, "tree", ".swc")]() -> hal::Result<std::filesystem::path> {
        HAL_CHECK(pipeline::write_swc(file, tree->tree, pipeline::LengthUnit::um, {},
                                      pipeline::Readers::owner));
        return file;
      });
}

} // namespace octascope::firmware_host
