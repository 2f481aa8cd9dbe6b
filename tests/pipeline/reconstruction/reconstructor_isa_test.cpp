// Which instruction set the fused path really uses, on this processor.
#include <string>

#include <gtest/gtest.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/files/calibrations.h"

namespace octascope::pipeline {
namespace {

Reconstructor fused(const std::string& isa) {
  return *Reconstructor::create({tests::chirped_calibration(1024, 70),
                                 SpectrumFormat{1024, hal::SampleType::u16}, 4,
                                 ReconstructionPath::fused, isa});
}

#if defined(__aarch64__)
TEST(ReconstructorIsa, is_neon_on_every_64_bit_arm) {
  for (const char* isa : {"", "NEON"}) {
    const Reconstructor reconstructor = fused(isa);
    EXPECT_EQ(reconstructor.path(), ReconstructionPath::fused);
    EXPECT_STREQ(reconstructor.isa(), "NEON");
  }
}
#elif defined(__x86_64__)
TEST(ReconstructorIsa, is_the_widest_that_the_processor_has) {
  const char* widest = __builtin_cpu_supports("x86-64-v4")   ? "AVX3"
                       : __builtin_cpu_supports("x86-64-v3") ? "AVX2"
                       : __builtin_cpu_supports("sse4.2")    ? "SSE4"
                                                             : "native";
  EXPECT_STREQ(fused("").isa(), widest);
}
#endif

TEST(ReconstructorIsa, that_is_unknown_leaves_the_other_path) {
  EXPECT_EQ(fused("ALTIVEC").path(), ReconstructionPath::fftw);
  EXPECT_STREQ(fused("ALTIVEC").isa(), "native");
}

} // namespace
} // namespace octascope::pipeline
