// NRRD: a volume that keeps its promises, or a message.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "pipeline/files/nrrd.h"
#include "tests/fuzz/expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace octascope;
  const auto read = pipeline::parse_nrrd(std::as_bytes(std::span{bytes, size}), "name");
  if (!read) {
    tests::expect_refusal(read.error().message);
    return 0;
  }
  const pipeline::VolumeGeometry& g = read->geometry;
  for (const double spacing : {g.depth_spacing_um, g.a_spacing_um, g.b_spacing_um})
    tests::expect(std::isfinite(spacing) && spacing > 0, "spacings are lengths");
  const auto levels = std::visit([](const auto& all) { return all.size(); }, read->levels);
  tests::expect(levels == g.voxels(), "there is a level for each voxel");
  tests::expect(levels <= 1032 * size, "the file accounts for all of them");
  return 0;
}
