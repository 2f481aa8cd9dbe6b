#include "firmware-host/commands/volume/flow_volumes.h"

#include <utility>

namespace octascope::firmware_host {

FlowVolumes::Worker::Worker(FlowVolumes& volumes, pipeline::BScanFlow flow)
    : volumes_(&volumes), computer_(std::move(flow)),
      bins_(computer_.voxels() * static_cast<std::size_t>(volumes.setup_.repeats)),
      flow_(computer_.voxels()), decorrelation_(computer_.voxels()) {}

std::span<pipeline::PackedBin> FlowVolumes::Worker::bins(std::size_t repeat) {
  return std::span{bins_}.subspan(repeat * computer_.voxels(), computer_.voxels());
}

hal::Result<> FlowVolumes::Worker::write_b_scan(int b) {
  const auto outcome = computer_.compute(bins_, flow_, decorrelation_);
  if (outcome.left_out)
    volumes_->left_out_.fetch_add(1);
  if (volumes_->flow_)
    HAL_CHECK(volumes_->flow_->write_b_scan(b, flow_));
  if (volumes_->decorrelation_)
    HAL_CHECK(volumes_->decorrelation_->write_b_scan(b, decorrelation_));
  return {};
}

FlowVolumes::FlowVolumes(FlowVolumes&& other) noexcept
    : setup_(other.setup_), flow_(std::move(other.flow_)),
      decorrelation_(std::move(other.decorrelation_)) {}

hal::Result<FlowVolumes>
FlowVolumes::create(const pipeline::FlowSetup& setup, const pipeline::VolumeGeometry& geometry,
                    const std::optional<std::filesystem::path>& flow,
                    const std::optional<std::filesystem::path>& decorrelation) {
  FlowVolumes volumes{setup};
  const auto open = [&](const std::filesystem::path& file, const char* content) {
    return pipeline::NrrdWriter::create(file, geometry, pipeline::NrrdType::float32,
                                        {{std::string{pipeline::nrrd_content}, content}});
  };
  if (flow) {
    HAL_TRY(auto writer, open(*flow, "flow: 0 static to 1 flowing, NaN not told"));
    volumes.flow_.emplace(std::move(writer));
  }
  if (decorrelation) {
    HAL_TRY(auto writer, open(*decorrelation, "decorrelation between repeats"));
    volumes.decorrelation_.emplace(std::move(writer));
  }
  return volumes;
}

hal::Result<FlowVolumes::Worker> FlowVolumes::make_worker() {
  HAL_TRY(auto flow, pipeline::BScanFlow::create(setup_));
  return Worker{*this, std::move(flow)};
}

hal::Result<> FlowVolumes::commit() {
  if (flow_)
    HAL_CHECK(flow_->commit());
  if (decorrelation_)
    HAL_CHECK(decorrelation_->commit());
  return {};
}

} // namespace octascope::firmware_host
