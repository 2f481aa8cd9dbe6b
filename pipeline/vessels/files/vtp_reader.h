// Vessel trees from VTK XML poly data (.vtp): centrelines with a radius at every point, as VMTK and
// others write them.
//
// Format: VTK File Formats (docs.vtk.org). Little-endian; ascii, binary and appended arrays, plain
// or compressed by zlib. Lines are joined into a tree (centreline_joiner.h); cells that are no
// lines are counted and left out. The radius is the point array "MaximumInscribedSphereRadius"
// (VMTK) or one named "radius" in whatever letters.
//
// Loaded whole or refused, as SWC files are; the orders are computed (vessel_orders.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/result.h"
#include "pipeline/vessels/files/tree_reading.h"

namespace octascope::pipeline {

struct VtpCounts {
  std::uint64_t points = 0; // in the file
  std::uint64_t lines = 0;
  std::uint64_t nodes = 0;         // = points − merged − unused
  std::uint64_t merged_points = 0; // of vessels that another line gave
  std::uint64_t unused_points = 0; // in no line
  std::uint64_t short_lines = 0;   // of one point or none
  std::uint64_t other_cells = 0;   // vertices, polygons, strips
  std::uint64_t roots = 0;
  std::uint64_t zero_radii = 0; // each now has its parent's
  std::uint64_t coincident = 0; // nodes at their parent's place, to the last bit
  std::string radius_array;
};

using VtpTree = ReadTree<VtpCounts>;

// The whole file is held in memory while it is read.
hal::Result<VtpTree> read_vtp(const std::filesystem::path& file,
                              const TreeReadOptions& options = {});

// The same from a text in memory; `name` stands for the file in messages.
hal::Result<VtpTree> parse_vtp(std::string_view text, const std::filesystem::path& name,
                               const TreeReadOptions& options = {});

} // namespace octascope::pipeline
