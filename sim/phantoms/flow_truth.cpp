#include "sim/phantoms/flow_truth.h"

#include <algorithm>

#include "sim/phantoms/phantom_profile.h"

namespace octascope::sim {

std::vector<float> flow_truth(const Phantom& phantom, const pipeline::VolumeGeometry& geometry) {
  const ProfileMaker maker(geometry, 0);
  ProfileMaker::Profile profile = maker.make_profile();
  Column column;
  std::vector<float> truth(geometry.voxels());
  auto at = truth.begin();
  const auto place = [](int index, int count, double spacing_um) {
    return static_cast<float>((index - (count - 1) / 2.0) * spacing_um * 1e-3);
  };
  for (int b = 0; b < geometry.b_scans; ++b) {
    const float y_mm = place(b, geometry.b_scans, geometry.b_spacing_um);
    for (int a = 0; a < geometry.a_scans; ++a) {
      const float x_mm = place(a, geometry.a_scans, geometry.a_spacing_um);
      phantom.fill(column, 0, x_mm, y_mm);
      maker.fill(profile, column, x_mm, y_mm, {});
      at = std::ranges::copy(profile.flowing_share, at).out;
    }
  }
  return truth;
}

} // namespace octascope::sim
