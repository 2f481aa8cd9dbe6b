// Shared by the readers of vessel trees: the caller's choices, and what is done to every tree.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>

#include "hal/result.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// Larger places and radii are refused; squares of smaller ones fit into a float.
inline constexpr float largest_vessel_length_mm = 1e9F;

enum class LengthUnit : std::uint8_t { um, mm };

// What a radius of 0 becomes.
enum class ZeroRadius : std::uint8_t {
  parent, // the parent's radius; at a root the smallest of the file that is not 0
  refuse, // the file is refused
};

struct TreeLimits {
  std::uint64_t rows = 100'000'000; // nodes of a text; points of a VTP file, and of its lines
  std::uint64_t bytes = std::uint64_t{16} << 30;
};

struct TreeReadOptions {
  // The files do not say: it is the caller's declaration. Nothing: what is usual for the format,
  // micrometres for SWC and millimetres for VTP.
  std::optional<LengthUnit> unit;
  bool forest = false; // several roots are fine
  bool strict = false; // a parent in a later row is not
  ZeroRadius zero_radius = ZeroRadius::parent;
  TreeLimits limits;
  // Called on the reader's thread with how much of the file is read, 0 to 1; may be empty.
  std::function<void(double)> progress;
  // When it is requested, reading ends soon with ErrorCode::disconnected; for VTP files between two
  // pieces.
  std::stop_token stop;
};

// What a reader made of a file; `Counts` are of its kind.
template <class Counts> struct ReadTree {
  VesselTree tree;
  Counts counts;
  LengthUnit unit = LengthUnit::mm; // of the file
};

// The error of a reading that was stopped. `name` is the file's.
tl::unexpected<hal::Error> reading_stopped(const std::filesystem::path& name);

// Does what `policy` says about radii of 0; parents come before their children. How many there
// were, or an error: where they are refused, and where no radius is more than 0. `name` is the
// file's.
hal::Result<std::uint64_t> mend_zero_radii(VesselTree& tree, ZeroRadius policy,
                                           const std::filesystem::path& name);

// How many nodes lie where their parent does: they stay in the tree, and are not drawn.
std::uint64_t count_coincident(const VesselTree& tree);

} // namespace octascope::pipeline
