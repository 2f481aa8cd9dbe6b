// Scalable vectors have no lane count to compile for, and SSSE3 adds nothing between the others.
#define HWY_DISABLED_TARGETS                                                                       \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#define HWY_TARGET_INCLUDE "pipeline/fused_kernels_inl.h"
#include <hwy/foreach_target.h> // includes the file above once for each instruction set but one

#include "pipeline/fused_kernels_inl.h"

namespace octascope::pipeline {

HWY_EXPORT(kernels);

const FusedKernels* fused_kernels(int samples, std::string_view isa) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) { // the widest first
    hwy::ChosenTarget only;
    only.Update(target);
    const FusedKernels* candidate = HWY_DISPATCH_TABLE(kernels)[only.GetIndex()]();
    if (candidate != nullptr && samples >= fewest_blocks * candidate->window.lanes &&
        (isa.empty() || isa == candidate->isa))
      return candidate;
  }
  return nullptr;
}

} // namespace octascope::pipeline
