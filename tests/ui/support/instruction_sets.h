// The instruction sets that the ray caster's kernels were compiled for and this processor has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <hwy/highway.h>

#include "ui/ray_caster/ray_kernels.h"

namespace octascope::tests {

inline std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    if (ui::ray_kernels(hwy::TargetName(target)) != nullptr)
      names.emplace_back(hwy::TargetName(target));
  return names;
}

} // namespace octascope::tests
