// Centrelines of any shape, joined: a tree or a loop, and no point lost from the count. The reader's
// own fuzzer hardly ever finds lines that run along each other.
#include <cstddef>
#include <cstdint>
#include <span>

#include "pipeline/vessels/centrelines/centreline_joiner.h"
#include "pipeline/vessels/files/tree_reading.h"
#include "tests/fuzz/tree_check.h"

namespace {

using namespace octascope;

// Each four bytes a point: three coordinates of a sixteenth, and what becomes of it: a new line, a
// point of a line before, a small or a great radius.
pipeline::Centrelines lines_of(std::span<const std::uint8_t> bytes) {
  pipeline::Centrelines lines;
  for (; bytes.size() >= 4; bytes = bytes.subspan(4)) {
    const unsigned kind = bytes[3];
    if ((kind & 1U) != 0 && !lines.points.empty())
      lines.ends.push_back(lines.points.size());
    const std::size_t points = lines.positions_mm.size();
    if ((kind & 6U) == 6 && points > 0) {
      lines.points.push_back((bytes[0] + 256U * bytes[1]) % points);
      continue;
    }
    lines.points.push_back(points);
    const double offset = (kind & 8U) != 0 ? 1e-6 : 0;
    lines.positions_mm.push_back({bytes[0] / 16.0 + offset, bytes[1] / 16.0, bytes[2] / 64.0});
    lines.radii_mm.push_back((kind & 16U) != 0 ? 2.0 : (kind >> 5U) / 4.0 + 1e-3);
  }
  lines.ends.push_back(lines.points.size());
  return lines;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const pipeline::Centrelines lines = lines_of({bytes, size});
  const pipeline::JoinedCentrelines joined = pipeline::join_centrelines(lines);
  if (!joined.loop.empty()) {
    tests::expect(joined.tree.nodes() == 0, "a loop is no tree");
    return 0;
  }
  tests::expect(joined.tree.nodes() + joined.merged_points + joined.unused_points ==
                    lines.positions_mm.size(),
                "every point is counted");
  if (joined.tree.nodes() > 0)
    tests::expect_tree(joined.tree);
  return 0;
}
