#include "firmware-host/configuration/kept/settings_store.h"

#include <chrono>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;

constexpr hal::Duration looked_every = 2s;
constexpr hal::Duration tried_again_after = 30s;

} // namespace

std::optional<RestoredView> SettingsStore::restore(const ConfiguredView& configured) {
  std::error_code error;
  if (!std::filesystem::exists(file_, error)) {
    kept_ = settings_text(configured, configured.view); // nothing: no need of a file
    return std::nullopt;
  }
  auto read = read_settings(file_, configured);
  if (read)
    return *read;
  was_broken_ = true;
  std::filesystem::path aside = file_;
  aside += ".broken";
  std::filesystem::rename(file_, aside, error);
  faults_.add(pipeline::Fault::settings_broken,
              fmt::format("{}; set aside as {}", read.error().message, aside.filename().string()),
              clock_.now());
  return std::nullopt;
}

void SettingsStore::take_written() {
  const auto written = writing_.take();
  if (!written)
    return;
  if (*written) {
    kept_ = std::move(writing_text_);
    return;
  }
  faults_.add(pipeline::Fault::settings_not_kept, written->error().message, clock_.now());
  next_ = clock_.now() + tried_again_after;
}

void SettingsStore::write(std::string text) {
  writing_text_ = text;
  writing_.start([file = file_, written = std::move(text)] {
    return pipeline::write_atomically(file, written);
  });
}

void SettingsStore::note(const ConfiguredView& configured, const ui::ViewState& state) {
  const hal::TimePoint now = clock_.now();
  if (now < next_)
    return;
  next_ = now + looked_every;
  if (writing_.busy())
    return take_written();
  std::string text = settings_text(configured, state);
  if (!kept_ || text != *kept_)
    write(std::move(text));
}

void SettingsStore::finish(const ConfiguredView& configured, const ui::ViewState& state) {
  writing_.wait();
  take_written();
  std::string text = settings_text(configured, state);
  if (kept_ && text == *kept_)
    return;
  write(std::move(text));
  writing_.wait();
  take_written();
}

} // namespace octascope::firmware_host
