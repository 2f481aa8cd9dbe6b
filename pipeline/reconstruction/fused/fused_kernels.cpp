#if defined(__aarch64__)
// NEON is part of every such processor. Highway would ask for cryptography beside it, which some
// lack, if it could look for that at run time; so it may not.
#define TOOLCHAIN_MISS_SYS_AUXV_H
#endif
// Scalable vectors have no lane count to compile for, SSSE3 adds nothing between the others, nor do
// the extensions of AVX3, of which newer versions of Highway know more.
#define HWY_DISABLED_TARGETS                                                                       \
  (HWY_SSSE3 | (HWY_AVX3 - 1) | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#define HWY_TARGET_INCLUDE "pipeline/reconstruction/fused/fused_kernels_inl.h"
#include <hwy/foreach_target.h> // includes the file above once for each instruction set but one

#include "pipeline/reconstruction/fused/fused_kernels_inl.h"

namespace octascope::pipeline {

HWY_EXPORT(kernels);

namespace {

bool serves(const FusedKernels* kernels, int samples, std::string_view isa) {
  return kernels != nullptr && samples >= fewest_blocks * kernels->window.lanes &&
         (isa.empty() || isa == kernels->isa);
}

} // namespace

const FusedKernels* fused_kernels(int samples, std::string_view isa) {
#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0 // the only instruction set there is needs no table
  const FusedKernels* only = HWY_STATIC_DISPATCH(kernels)();
  return serves(only, samples, isa) ? only : nullptr;
#else
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) { // the widest first
    hwy::ChosenTarget only;
    only.Update(target);
    const FusedKernels* candidate = HWY_DISPATCH_TABLE(kernels)[only.GetIndex()]();
    if (serves(candidate, samples, isa))
      return candidate;
  }
  return nullptr;
#endif
}

} // namespace octascope::pipeline
