#include "firmware-host/configuration/kept/last_good_store.h"

#include <utility>

namespace octascope::firmware_host {

void LastGoodStore::begin(const std::filesystem::path& configuration) {
  began_ = clock_.now();
  wanted_ = configuration;
  read_wanted();
}

// What was read of the file before is of no use any more.
void LastGoodStore::read_wanted() {
  reading_.take();
  if (reading_.start([file = *wanted_] { return ConfigurationBundle::gather(file); }))
    wanted_.reset();
}

bool LastGoodStore::is_proved(bool picture_shown) const {
  return picture_shown || clock_.now() - began_ >= proved_after;
}

void LastGoodStore::advance(bool picture_shown) {
  const auto complain = [&](const hal::Error& error) {
    faults_.add(pipeline::Fault::configuration_not_kept, error.message, clock_.now());
  };
  if (const auto written = writing_.take(); written && !*written)
    complain(written->error());
  if (wanted_)
    read_wanted();
  if (wanted_ || writing_.busy() || !is_proved(picture_shown))
    return;
  auto bundle = reading_.take();
  if (!bundle)
    return;
  if (!*bundle) {
    complain(bundle->error());
    return;
  }
  writing_.start([folder = folder_, kept = std::move(**bundle)] { return folder.keep(kept); });
}

void LastGoodStore::finish(bool picture_shown) {
  while (writing_.busy() || (reading_.busy() && is_proved(picture_shown))) {
    writing_.wait();
    reading_.wait();
    advance(picture_shown);
  }
}

} // namespace octascope::firmware_host
