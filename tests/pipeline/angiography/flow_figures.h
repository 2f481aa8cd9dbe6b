// How well a flow map tells what flows from what does not.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "tests/pipeline/angiography/speckle_scene.h"

namespace octascope::tests {

struct FlowFigures {
  double area = 0;        // under the curve of true against false positives
  double false_share = 0; // of static voxels that are called flowing, ½ or more
  double told_share = 0;  // of tissue that is more than 3 dB above the noise
};

inline FlowFigures flow_figures(const SpeckleScene& scene, std::span<const float> flow) {
  std::vector<std::pair<float, bool>> values;
  double tissue = 0;
  for (int a = 0; a < scene.a_scans; ++a)
    for (int z = static_cast<int>(scene.surface) + 2; z < scene.depths; ++z) {
      if (scene.power(z) < 2)
        continue;
      ++tissue;
      const float value = flow[static_cast<std::size_t>(a * scene.depths + z)];
      if (!std::isnan(value))
        values.emplace_back(value, scene.flows(a, z));
    }
  std::sort(values.begin(), values.end());
  FlowFigures figures;
  double flowing = 0, still = 0, below = 0, called = 0;
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i;
    double ties = 0, ties_flowing = 0;
    for (; end < values.size() && values[end].first == values[i].first; ++end)
      (values[end].second ? ties_flowing : ties) += 1;
    below += ties_flowing * (still + ties / 2);
    still += ties;
    flowing += ties_flowing;
    if (values[i].first >= 0.5F)
      called += ties;
    i = end;
  }
  figures.area = below / (flowing * still);
  figures.false_share = called / still;
  figures.told_share = (flowing + still) / tissue;
  return figures;
}

// Of B-scans of one scene, at least one.
inline FlowFigures mean_of(std::span<const FlowFigures> all) {
  FlowFigures mean;
  const auto share = 1 / static_cast<double>(all.size());
  for (const auto& figures : all) {
    mean.area += share * figures.area;
    mean.false_share += share * figures.false_share;
    mean.told_share += share * figures.told_share;
  }
  return mean;
}

} // namespace octascope::tests
