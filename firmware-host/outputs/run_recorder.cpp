#include "firmware-host/outputs/run_recorder.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/outputs/dated_file.h"
#include "firmware-host/outputs/local_time.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;

// A second of volumes: what a disk that is busy with something else may hold up. Fewer of very
// large ones.
constexpr std::size_t most_places = 8;
constexpr std::size_t memory_for_places = std::size_t{128} << 20;

std::size_t places_for(const pipeline::VolumeGeometry& geometry) {
  return std::clamp(memory_for_places / geometry.voxels(), std::size_t{2}, most_places);
}

constexpr hal::Duration patience_with_disk = 10s;

} // namespace

RunRecorder::RunRecorder(RecordingSetup setup, hal::Clock& clock, pipeline::FaultLog& faults,
                         pipeline::Wakeup& news)
    : setup_(std::move(setup)), clock_(clock),
      recorder_(setup_.facts.geometry, places_for(setup_.facts.geometry), clock, faults, news) {}

hal::Result<> RunRecorder::check() const {
  if (!setup_.file)
    return {};
  std::error_code ignored;
  if (std::filesystem::exists(*setup_.file, ignored))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     setup_.file->string() + " is there already, and a recording is never written "
                                             "over: choose another name, or remove it");
  HAL_CHECK(pipeline::AtomicFile::create(*setup_.file));
  return {};
}

hal::Result<> RunRecorder::start(const pipeline::ThreadSetup& setup) {
  recorder_.start(setup);
  if (!setup_.file)
    return {};
  begin(*setup_.file);
  const hal::TimePoint deadline = clock_.now() + patience_with_disk;
  while (!recorder_.status().on) {
    if (const auto failure = recorder_.failure())
      return hal::fail(hal::ErrorCode::system, failure->message);
    if (clock_.now() > deadline)
      return hal::fail(hal::ErrorCode::timed_out,
                       setup_.file->string() +
                           ": its disk has not answered for ten seconds: look at it, or "
                           "record to another one");
    clock_.sleep_for(1ms);
  }
  return {};
}

void RunRecorder::stop() {
  recorder_.stop();
  note_counts();
}

std::string_view RunRecorder::toggle() {
  if (recorder_.status().on) {
    recorder_.end();
    return "ended";
  }
  std::error_code ignored; // a file that cannot be made is a fault of its own
  std::filesystem::create_directories(setup_.folder, ignored);
  return begin(free_dated_name(setup_.folder, "octascope", ".h5"))
             ? "begun"
             : "not begun: the last one is being finished";
}

bool RunRecorder::begin(const std::filesystem::path& file) {
  note_counts();
  pipeline::RecordingFacts facts = setup_.facts;
  facts.begun = now_in_iso_8601();
  if (!recorder_.begin(file, std::move(facts)))
    return false;
  kept_.push_back({file});
  return true;
}

// Of the newest; the recorder counts anew for each.
void RunRecorder::note_counts() {
  if (kept_.empty())
    return;
  const pipeline::RecorderStatus status = recorder_.status();
  kept_.back().kept = status.kept;
  kept_.back().not_kept = status.not_kept;
  kept_.back().failure = recorder_.failure();
}

hal::Result<> RunRecorder::outcome() const {
  if (!setup_.file || kept_.empty())
    return {};
  const KeptRecording& recording = kept_.front();
  if (!recording.is_there())
    return tl::make_unexpected(*recording.failure);
  const std::string holds = recording.kept > 0 ? fmt::format("it holds {} volumes", recording.kept)
                                               : "it holds no volume";
  if (recording.failure)
    return hal::fail(recording.failure->code, "{}; {}", recording.failure->message, holds);
  if (recording.kept == 0)
    return hal::fail(
        hal::ErrorCode::bad_data, "{}: {}: {}", recording.file.string(), holds,
        recording.not_kept > 0
            ? fmt::format("its disk was too slow for the {} that came", recording.not_kept)
            : std::string{"none came while it was recorded"});
  return {};
}

std::optional<hal::Duration> time_left(hal::Duration lasted, std::uint64_t kept,
                                       std::optional<std::uint64_t> room) {
  if (kept == 0 || !room)
    return std::nullopt;
  constexpr double longest = 1e18; // of nanoseconds, 30 years
  const double each = static_cast<double>(lasted.count()) / static_cast<double>(kept);
  return hal::Duration{
      static_cast<std::int64_t>(std::min(each * static_cast<double>(*room), longest))};
}

ui::RecordingStatus RunRecorder::status(hal::TimePoint now) const {
  const pipeline::RecorderStatus recorder = recorder_.status();
  ui::RecordingStatus status;
  status.on = recorder.on;
  if (!status.on)
    return status;
  status.lasted = now - recorder.since;
  status.not_kept = recorder.not_kept;
  status.room = time_left(status.lasted, recorder.kept, recorder.room);
  return status;
}

} // namespace octascope::firmware_host
