#include "firmware-host/configuration/kept/last_good_store.h"

#include <chrono>
#include <utility>

namespace octascope::firmware_host {

namespace {

template <class Value> bool is_ready(const std::future<Value>& future) {
  using namespace std::chrono_literals;
  return future.valid() && future.wait_for(0s) == std::future_status::ready;
}

} // namespace

void LastGoodStore::begin(const std::filesystem::path& configuration) {
  began_ = clock_.now();
  read_ = std::async(std::launch::async,
                     [configuration] { return ConfigurationBundle::gather(configuration); });
}

void LastGoodStore::advance(bool picture_shown) {
  const auto complain = [&](const hal::Error& error) {
    faults_.add(pipeline::Fault::configuration_not_kept, error.message, clock_.now());
  };
  if (is_ready(written_))
    if (const auto written = written_.get(); !written)
      complain(written.error());
  if (written_.valid() || !is_ready(read_) ||
      (!picture_shown && clock_.now() - began_ < proved_after))
    return;
  auto bundle = read_.get();
  if (!bundle) {
    complain(bundle.error());
    return;
  }
  written_ = std::async(std::launch::async, [folder = folder_, kept = std::move(*bundle)] {
    return folder.keep(kept);
  });
}

void LastGoodStore::finish(bool picture_shown) {
  if (written_.valid())
    written_.wait();
  if (read_.valid())
    read_.wait();
  advance(picture_shown);
  if (written_.valid())
    written_.wait();
  advance(picture_shown); // hears what became of it
}

} // namespace octascope::firmware_host
