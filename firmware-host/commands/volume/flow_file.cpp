#include "firmware-host/commands/volume/flow_file.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "pipeline/files/nrrd.h"
#include "pipeline/volume/flow_scale.h"

namespace octascope::firmware_host {

namespace {

bool is_flow(float value) {
  return std::isnan(value) || (value >= 0 && value <= 1);
}

} // namespace

hal::Result<> read_flow_beside(const std::filesystem::path& file, pipeline::Volume& volume) {
  HAL_TRY(const auto read, pipeline::read_nrrd(file));
  const auto* flow = std::get_if<std::vector<float>>(&read.levels);
  if (flow == nullptr || read.content.starts_with("decorrelation") ||
      !std::ranges::all_of(*flow, is_flow))
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: found levels or decorrelation, expected a flow volume, numbers from 0 "
                     "(static) to 1 (flowing): octascope reconstruct --flow writes one",
                     file.string());
  const pipeline::VolumeGeometry& found = read.geometry;
  const pipeline::VolumeGeometry& expected = volume.geometry;
  if (found.depths != expected.depths || found.a_scans != expected.a_scans ||
      found.b_scans != expected.b_scans)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{}: found {} depths x {} A-scans x {} B-scans, expected those of the volume, "
                     "{} x {} x {}",
                     file.string(), found.depths, found.a_scans, found.b_scans, expected.depths,
                     expected.a_scans, expected.b_scans);
  volume.add_flow();
  std::ranges::transform(*flow, volume.flow.begin(), pipeline::quantise_flow);
  for (int b = 0; b < expected.b_scans; ++b) {
    const bool told = std::ranges::any_of(
        volume.b_scan_flow(b), [](std::uint8_t count) { return count != pipeline::flow_untold; });
    volume.flow_states[static_cast<std::size_t>(b)] =
        told ? pipeline::FlowState::told : pipeline::FlowState::left_out;
  }
  return {};
}

} // namespace octascope::firmware_host
