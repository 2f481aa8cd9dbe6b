// One vessel tree as clusters, for commands that draw or measure: from a file of any supported
// format.
#pragma once

#include <cstddef>
#include <filesystem>
#include <variant>

#include "hal/result.h"
#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/cluster_facts.h"
#include "pipeline/vessels/clusters/cluster_file.h"
#include "pipeline/vessels/files/tree_reading.h"

namespace octascope::firmware_host {

// Owns the clusters' memory: a mapped file or arrays. Reading is safe from any thread.
class LoadedVessels {
public:
  explicit LoadedVessels(pipeline::ClusterFile file) : owner_{std::move(file)} {}
  LoadedVessels(pipeline::ClusterArrays arrays, pipeline::VesselFacts facts)
      : owner_{Built{std::move(arrays), std::move(facts)}} {}

  // The spans are valid as long as this object, or the one it was moved to.
  pipeline::VesselClusters clusters() const;
  const pipeline::VesselFacts& facts() const;
  std::size_t bytes() const; // of clusters, nodes and sources
  bool is_mapped() const;    // else packed from SWC or VTP

private:
  struct Built {
    pipeline::ClusterArrays arrays;
    pipeline::VesselFacts facts;
  };

  std::variant<pipeline::ClusterFile, Built> owner_;
};

// Maps our own format; reads and packs SWC and VTP by `options`, calling options.progress with 0 to
// 1 and obeying options.stop. Errors as in tree_file.h and cluster_file.h.
hal::Result<LoadedVessels> load_vessels(const std::filesystem::path& file,
                                        const pipeline::TreeReadOptions& options = {});

} // namespace octascope::firmware_host
