// A vessel tree in a file that is mapped and drawn from as it is.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "hal/result.h"
#include "pipeline/files/input_file.h"
#include "pipeline/vessels/clusters.h"
#include "pipeline/vessels/clusters/cluster_facts.h"

namespace octascope::pipeline {

// The content of a file's bytes; `clusters` borrows from them.
struct ClusterFileContent {
  VesselClusters clusters;
  VesselFacts facts;
};

// Checks all of it: magic, version, byte order, sizes, checksums, and every index that a reader
// will follow. The result can be drawn and unpacked without further checks, whoever wrote the
// file. ErrorCode::bad_data, with `name`, the offset, what was found and what was expected.
// `bytes` must be aligned to 8 bytes.
hal::Result<ClusterFileContent> read_cluster_bytes(std::span<const std::byte> bytes,
                                                   std::string_view name);

// An open, mapped file; any thread may read from it. Replacing the file on disk (as
// write_cluster_file() does) is safe; overwriting it in place changes it under its readers.
class ClusterFile {
public:
  // Faults: absent, denied, invalid_argument for what is no regular file, and those of
  // read_cluster_bytes().
  static hal::Result<ClusterFile> open(const std::filesystem::path& file);

  // Valid as long as the object that open() returned, or that it was moved to.
  const VesselClusters& clusters() const { return content_.clusters; }
  const VesselFacts& facts() const { return content_.facts; }
  std::size_t bytes() const { return mapped_.bytes().size(); }

private:
  ClusterFile(MappedFile mapped, ClusterFileContent content)
      : mapped_{std::move(mapped)}, content_{std::move(content)} {}

  MappedFile mapped_;
  ClusterFileContent content_;
};

// The file appears complete or not at all. `facts` are those of the tree that was packed
// (facts_of()). Faults as AtomicFile's, and ErrorCode::invalid_argument for clusters and facts that
// do not belong together, and for a provenance of more than longest_provenance bytes.
hal::Result<> write_cluster_file(const std::filesystem::path& file, const VesselClusters& clusters,
                                 const VesselFacts& facts);

} // namespace octascope::pipeline
