// Vessel trees from SWC files: text, a node a row, `id type x y z radius parent`.
//
// Format: Cannon, Turner, Pyapali, Wheal, J Neurosci Methods 84, 1998, and the INCF's description
// (swc-specification.readthedocs.io), read strictly: a file is loaded whole and as it says, or
// refused with file:line:column of the first row that is wrong, what was found and expected.
//
// - Seven tokens a row with blanks or tabs between; `#` begins a comment, in a line of its own or
//   behind the seven. Byte-order mark, CRLF and blank lines are fine.
// - id: 0 to 4294967294, each once. Parent: −1 for a root, else the id of any row. One root, or
//   several with `forest`, or where a comment of
//   ours says as many (swc_comments.h). Parents may come later (unless `strict`): rows are then
//   sorted, and stay in the file's order otherwise.
// - Numbers are decimal, finite, and at most 10⁹ mm; they are rounded once, to float millimetres.
// - Nothing recurses: a chain of any length is read.
//
// Types: any from 0 up. 16, 17 and 18 are the branches RCA, LAD and LCX. The INCF names 0 to 7 and
// leaves larger ones to the user, so that a file of others may use these three for something of its
// own: its vessels are coloured as branches then, and nothing else changes.
//
// Orders: SWC has no place for them. swc_writer.h keeps them in comments; where those are missing,
// or do not fit the rows any more, they are computed (vessel_orders.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string_view>

#include "hal/result.h"
#include "pipeline/vessels/files/tree_reading.h"

namespace octascope::pipeline {

inline constexpr std::uint32_t largest_swc_id = 0xFFFFFFFE;
inline constexpr std::uint32_t first_branch_type = 16; // VesselBranch::rca

struct SwcCounts {
  std::uint64_t rows = 0; // = nodes + comments + blanks
  std::uint64_t nodes = 0;
  std::uint64_t comments = 0;
  std::uint64_t blanks = 0;
  std::uint64_t roots = 0;
  std::uint64_t late_parents = 0;               // nodes whose parent comes later
  std::uint64_t zero_radii = 0;                 // each now has its parent's
  std::uint64_t coincident = 0;                 // nodes at their parent's place
  std::map<std::uint32_t, std::uint64_t> types; // how many nodes have which
  bool orders_in_file = false;
};

using SwcTree = ReadTree<SwcCounts>;

// 25 bytes a node while it reads, orders apart.
hal::Result<SwcTree> read_swc(const std::filesystem::path& file,
                              const TreeReadOptions& options = {});

// The same from a text in memory; `name` stands for the file in messages.
hal::Result<SwcTree> parse_swc(std::string_view text, const std::filesystem::path& name,
                               const TreeReadOptions& options = {});

} // namespace octascope::pipeline
