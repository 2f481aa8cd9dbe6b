#include "firmware-host/vessels/vessel_files.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/cluster_file.h"
#include "pipeline/vessels/files/swc_writer.h"

namespace octascope::firmware_host {

namespace {

// In small letters.
std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

} // namespace

hal::Result<> check_tree_name(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  if (ending.empty() || ending == ".swc" || ending == ".vessels")
    return {};
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "--out is \"{}\", whose ending says another format, expected .vessels (our own) "
                   "or .swc",
                   file.string());
}

hal::Result<> write_tree(const std::filesystem::path& file, const pipeline::VesselTree& tree,
                         std::string provenance, const std::function<void(double)>& progress) {
  HAL_CHECK(check_tree_name(file));
  if (ending_of(file) == ".swc")
    return pipeline::write_swc(file, tree, pipeline::LengthUnit::um, progress);
  const pipeline::ClusterArrays arrays = pipeline::build_clusters(tree);
  return pipeline::write_cluster_file(
      file, arrays.view(), pipeline::facts_of(tree, arrays.error, std::move(provenance)));
}

} // namespace octascope::firmware_host
