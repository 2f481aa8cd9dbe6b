#include "ui/vessels/splatter/splat_kernels.h"

// Scalable vectors have no lane count to compile for, SSSE3 adds nothing between the others, nor do
// the extensions of AVX3, of which newer versions of Highway know more.
#define HWY_DISABLED_TARGETS                                                                       \
  (HWY_SSSE3 | (HWY_AVX3 - 1) | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#define HWY_TARGET_INCLUDE "ui/vessels/splatter/splat_kernels_inl.h"
#include <hwy/foreach_target.h> // includes the file above once for each instruction set but one

#include "ui/vessels/splatter/splat_kernels_inl.h"

namespace octascope::ui {

HWY_EXPORT(splat_kernels_of_target);

const SplatKernels* splat_kernels(std::string_view isa) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) { // the widest first
    hwy::ChosenTarget only;
    only.Update(target);
    const SplatKernels* candidate = HWY_DISPATCH_TABLE(splat_kernels_of_target)[only.GetIndex()]();
    if (candidate != nullptr && (isa.empty() || isa == candidate->isa))
      return candidate;
  }
  return nullptr;
}

} // namespace octascope::ui
