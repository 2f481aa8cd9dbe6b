// The volumes of flow and of decorrelation that `reconstruct` writes beside the levels.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/angiography/b_scan_flow.h"
#include "pipeline/files/nrrd.h"

namespace octascope::firmware_host {

class FlowVolumes {
public:
  // What one thread computes B-scans with.
  class Worker {
  public:
    // For the bins of a repeat, [a][z].
    std::span<pipeline::PackedBin> bins(std::size_t repeat);
    hal::Result<> write_b_scan(int b);

  private:
    friend class FlowVolumes;
    Worker(FlowVolumes& volumes, pipeline::BScanFlow flow);

    FlowVolumes* volumes_;
    pipeline::BScanFlow computer_;
    std::vector<pipeline::PackedBin> bins_;
    std::vector<float> flow_;
    std::vector<float> decorrelation_;
  };

  // An empty name: that one is not written.
  static hal::Result<FlowVolumes> create(const pipeline::FlowSetup& setup,
                                         const pipeline::VolumeGeometry& geometry,
                                         const std::optional<std::filesystem::path>& flow,
                                         const std::optional<std::filesystem::path>& decorrelation);
  FlowVolumes(FlowVolumes&& other) noexcept; // before any Worker was made

  hal::Result<Worker> make_worker();
  hal::Result<> commit();
  int left_out() const { return left_out_.load(); } // B-scans whose flow is not told

private:
  explicit FlowVolumes(const pipeline::FlowSetup& setup) : setup_(setup) {}

  pipeline::FlowSetup setup_;
  std::optional<pipeline::NrrdWriter> flow_;
  std::optional<pipeline::NrrdWriter> decorrelation_;
  std::atomic<int> left_out_{0};
};

} // namespace octascope::firmware_host
