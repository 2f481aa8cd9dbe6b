#include "pipeline/vessels/clusters/cluster_builder.h"

#include <span>

#include "pipeline/vessels/clusters/cluster_packer.h"
#include "pipeline/vessels/clusters/cluster_partition.h"

namespace octascope::pipeline {

ClusterArrays build_clusters(const VesselTree& tree, const std::stop_token& stop) {
  const ClusterPartition partition = partition_tree(tree, stop);
  if (stop.stop_requested())
    return {};
  ClusterPacker packer{tree};
  std::size_t begin = 0;
  for (const std::size_t end : partition.ends) {
    if (stop.stop_requested())
      return {};
    packer.pack(std::span{partition.segments}.subspan(begin, end - begin));
    begin = end;
  }
  return packer.finish();
}

} // namespace octascope::pipeline
