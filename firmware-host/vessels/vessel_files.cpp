#include "firmware-host/vessels/vessel_files.h"

#include <utility>

#include "pipeline/files/file_name.h"
#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/cluster_file.h"
#include "pipeline/vessels/files/swc_writer.h"
#include "pipeline/vessels/files/vtp_writer.h"

namespace octascope::firmware_host {

hal::Result<> write_tree(const std::filesystem::path& file, const pipeline::VesselTree& tree,
                         std::string provenance, const std::function<void(double)>& progress) {
  if (pipeline::file_ending(file) == ".swc")
    return pipeline::write_swc(file, tree, pipeline::LengthUnit::um, progress);
  if (pipeline::file_ending(file) == ".vtp")
    return pipeline::write_vtp(file, tree);
  const pipeline::ClusterArrays arrays = pipeline::build_clusters(tree);
  return pipeline::write_cluster_file(
      file, arrays.view(), pipeline::facts_of(tree, arrays.error, std::move(provenance)));
}

} // namespace octascope::firmware_host
