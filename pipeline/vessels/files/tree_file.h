// A vessel tree from a file of any known kind, recognised by its content, not its name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <variant>

#include "hal/result.h"
#include "pipeline/vessels/clusters/cluster_facts.h"
#include "pipeline/vessels/files/swc_reader.h"
#include "pipeline/vessels/files/vtp_reader.h"

namespace octascope::pipeline {

enum class TreeFileKind : std::uint8_t {
  swc,
  vtp,
  clusters, // our own: cluster_file.h
};

struct TreeFile {
  VesselTree tree;
  LengthUnit unit = LengthUnit::mm;                       // of the file
  std::variant<SwcCounts, VtpCounts, VesselFacts> counts; // by TreeFileKind
};

// Reads the beginning only. Faults as InputFile::open()'s, and ErrorCode::bad_data for what is none
// of them.
hal::Result<TreeFileKind> tree_file_kind(const std::filesystem::path& file,
                                         const TreeLimits& limits = {});

// Of our own format the nodes come in another sequence than they were packed in, moved by no more
// than VesselFacts::error (cluster_unpacker.h); of the options only `progress`
// and the limit of bytes concern it, and there may be no node: lone roots are not kept.
hal::Result<TreeFile> read_tree(const std::filesystem::path& file,
                                const TreeReadOptions& options = {});

} // namespace octascope::pipeline
