#include "firmware-host/vessels/vessel_loader.h"

#include <utility>

namespace octascope::firmware_host {

VesselLoader::VesselLoader(std::filesystem::path file, pipeline::Wakeup& news)
    : file_{std::move(file)}, news_{news}, thread_{[this](const std::stop_token& stop) {
        pipeline::TreeReadOptions options;
        options.forest = true; // three coronary arteries are three roots
        options.stop = stop;
        options.progress = [this](double progress) { note(progress); };
        loaded_.emplace(load_vessels(file_, options));
        done_.store(true, std::memory_order_release);
        news_.post();
      }} {}

void VesselLoader::note(double progress) {
  const auto now = static_cast<float>(progress);
  if (now - progress_.load(std::memory_order_relaxed) < 0.01F)
    return;
  progress_.store(now, std::memory_order_relaxed);
  news_.post();
}

std::optional<hal::Result<LoadedVessels>> VesselLoader::take() {
  if (!done_.load(std::memory_order_acquire))
    return std::nullopt;
  return std::exchange(loaded_, std::nullopt);
}

} // namespace octascope::firmware_host
