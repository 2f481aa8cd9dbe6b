// The benchmark, briefly: what it reports is complete, plausible and right.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/bench/bench_reconstruct.h"

namespace octascope::firmware_host {
namespace {

TEST(BenchReconstruct, reports_every_case_and_checks_the_results) {
#ifdef OCTASCOPE_SANITIZED
  GTEST_SKIP() << "a sanitized build has no speed to measure, and takes minutes to say so";
#endif
  const auto report = bench_reconstruct(0.1);
  ASSERT_TRUE(report) << report.error().message;
  const auto json = nlohmann::json::parse(to_json(*report));
  EXPECT_FALSE(json.at("cpu").get<std::string>().empty());
  EXPECT_GT(json.at("fftw_c2c_1024_ns").get<double>(), 0);
  EXPECT_GE(json.at("ring_mb").get<double>(), 50);
  int fftw_cases = 0;
  for (const auto& one : json.at("cases")) {
    const auto path = one.at("path").get<std::string>();
    EXPECT_TRUE(path == "fftw" || path == "fused") << path;
    fftw_cases += path == "fftw" ? 1 : 0;
    EXPECT_FALSE(one.at("isa").get<std::string>().empty());
    EXPECT_EQ(one.at("samples").get<int>(), 1024);
    EXPECT_TRUE(one.at("interpolation").is_string());
    EXPECT_TRUE(one.at("dispersion").is_boolean());
    EXPECT_TRUE(one.at("background") == "recorded" || one.at("background") == "running" ||
                one.at("background") == "mean")
        << one;
    EXPECT_GE(one.at("threads").get<int>(), 1);
    EXPECT_GT(one.at("lines_per_s").get<double>(), 0);
    EXPECT_GT(one.at("ratio_to_fftw").get<double>(), 0);
    EXPECT_GE(one.at("repeats").get<int>(), 7);
    EXPECT_GE(one.at("spread").get<double>(), 0);
    EXPECT_LE(one.at("max_count_error").get<int>(), 1) << one;
    EXPECT_LT(one.at("share_differing").get<double>(), 0.02) << one;
  }
  // Three interpolations; dispersion with each background, or none; one thread or two.
  EXPECT_EQ(fftw_cases, 24);
  EXPECT_EQ(json.at("cases").size() % 24, 0U);
}

} // namespace
} // namespace octascope::firmware_host
