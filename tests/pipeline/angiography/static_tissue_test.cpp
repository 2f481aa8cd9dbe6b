#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/angiography/static_tissue.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

// Planes of a B-scan of one tissue, whose vessels and tails are the same in all A-scans of its right
// tenth: a vessel at 40 to 60, its tail to 140, another vessel at 140 to 160 and its tail.
class Tails : public testing::Test {
protected:
  static constexpr int a_scans = 200;
  static constexpr int depths = 320;
  static constexpr int first_a = 180;
  static constexpr float noise = 3;

  void SetUp() override {
    std::mt19937 generator{tests::fresh_seed()};
    // The mean of 8.6 squared moduli.
    std::gamma_distribution<float> deviation{8.6F, 1 / 8.6F};
    for (int a = 0; a < a_scans; ++a)
      for (int z = 0; z < depths; ++z) {
        const float level = z < lit_depths ? 60 * noise : noise;
        level_.push_back(level);
        const float own = a < first_a ? 0
                          : z < 40    ? 0
                          : z < 60    ? 0.75F
                          : z < 140   ? tail
                          : z < 160   ? second_vessel
                                      : tail;
        decorrelation_.push_back(own + (1 - own) * noise / level * deviation(generator));
      }
  }
  // The median of flow over the A-scans with vessels.
  float flow_at(int z) const {
    std::vector<float> values;
    for (int a = first_a; a < a_scans; ++a)
      values.push_back(flow_[static_cast<std::size_t>(a * depths + z)]);
    std::nth_element(values.begin(), values.begin() + 10, values.end());
    return values[10];
  }
  StaticTissue classify() {
    StaticTissue tissue{FlowMethod::complex_bins, a_scans, depths, 2};
    const KernelPlanes planes{decorrelation_, level_, {}};
    tissue.measure(planes, 2.87F);
    tissue.classify(planes, flow_);
    return tissue;
  }

  float tail = 0.2F;
  float second_vessel = 0.7F;
  int lit_depths = 220;
  std::vector<float> decorrelation_;
  std::vector<float> level_;
  std::vector<float> flow_ = std::vector<float>(static_cast<std::size_t>(a_scans * depths));
};

TEST_F(Tails, are_suppressed_and_what_flows_below_them_is_not) {
  classify();
  EXPECT_LT(flow_at(30), 0.1F);
  EXPECT_GT(flow_at(50), 0.9F);
  EXPECT_GT(flow_at(59), 0.9F); // a vessel is no tail of itself
  EXPECT_LT(flow_at(70), 0.1F);
  EXPECT_LT(flow_at(130), 0.1F);
  EXPECT_GT(flow_at(150), 0.9F);
  EXPECT_LT(flow_at(200), 0.1F);
}

class LongTail : public Tails {
protected:
  LongTail() {
    second_vessel = tail = 0.25F;
    lit_depths = depths;
  }
};

TEST_F(LongTail, is_suppressed_however_far_below) {
  classify();
  EXPECT_GT(flow_at(50), 0.9F);
  for (const int z : {70, 150, 250, 315})
    EXPECT_LT(flow_at(z), 0.1F) << z;
}

TEST_F(Tails, noise_is_measured_in_tissue_and_below_it) {
  const StaticTissue tissue = classify();
  for (const int z : {10, 100, 200, 250, 300})
    EXPECT_NEAR(tissue.noise()[static_cast<std::size_t>(z)], noise, 0.2F * noise) << z;
  EXPECT_LT(tissue.static_decorrelation(), 0.02F);
  EXPECT_FALSE(tissue.incoherent());
  EXPECT_TRUE(std::isnan(flow_at(300)));
}

// Residual motion lifts all of static tissue.
TEST_F(Tails, what_all_tissue_shows_is_no_flow) {
  for (std::size_t i = 0; i < decorrelation_.size(); ++i)
    decorrelation_[i] += 0.15F * (1 - decorrelation_[i]);
  const StaticTissue tissue = classify();
  EXPECT_NEAR(tissue.static_decorrelation(), 0.15F, 0.05F);
  EXPECT_LT(flow_at(30), 0.1F);
  EXPECT_GT(flow_at(50), 0.9F);
}

} // namespace
} // namespace octascope::pipeline
