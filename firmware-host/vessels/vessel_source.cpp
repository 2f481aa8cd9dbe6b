#include "firmware-host/vessels/vessel_source.h"

#include <utility>

#include "pipeline/vessels/files/tree_file.h"

namespace octascope::firmware_host {

namespace {

using pipeline::ClusterArrays;
using pipeline::ClusterFile;

constexpr double share_of_reading = 0.7; // of the time; packing is the rest

} // namespace

pipeline::VesselClusters LoadedVessels::clusters() const {
  if (const auto* file = std::get_if<ClusterFile>(&owner_))
    return file->clusters();
  return std::get<Built>(owner_).arrays.view();
}

const pipeline::VesselFacts& LoadedVessels::facts() const {
  if (const auto* file = std::get_if<ClusterFile>(&owner_))
    return file->facts();
  return std::get<Built>(owner_).facts;
}

std::size_t LoadedVessels::bytes() const {
  const pipeline::VesselClusters held = clusters();
  return held.clusters.size_bytes() + held.nodes.size_bytes() + held.sources.size_bytes();
}

bool LoadedVessels::is_mapped() const {
  return std::holds_alternative<ClusterFile>(owner_);
}

hal::Result<LoadedVessels> load_vessels(const std::filesystem::path& file,
                                        const pipeline::TreeReadOptions& options) {
  HAL_TRY(const auto kind, pipeline::tree_file_kind(file, options.limits));
  if (kind == pipeline::TreeFileKind::clusters)
    return ClusterFile::open(file).map(
        [](ClusterFile&& mapped) { return LoadedVessels{std::move(mapped)}; });
  pipeline::TreeReadOptions reading = options;
  if (options.progress)
    reading.progress = [&](double done) { options.progress(share_of_reading * done); };
  HAL_TRY(const auto read, pipeline::read_tree(file, reading));
  ClusterArrays arrays = pipeline::build_clusters(read.tree, options.stop);
  if (options.stop.stop_requested())
    return pipeline::reading_stopped(file);
  auto facts = pipeline::facts_of(read.tree, arrays.error, file.filename().string());
  if (options.progress)
    options.progress(1);
  return LoadedVessels{std::move(arrays), std::move(facts)};
}

} // namespace octascope::firmware_host
