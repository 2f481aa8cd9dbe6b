// Who of GL and the processor draws which vessels.
#include <limits>
#include <optional>

#include "tests/support/vessels/random_tree.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/vessel_stage.h"
#include "ui/vessels/hybrid/hybrid_method.h"

namespace octascope::tests {
namespace {

class HybridMethod : public GlTest {
protected:
  void SetUp() override {
    open(VesselStage::width, VesselStage::height);
    if (!IsSkipped())
      stage_.emplace(random_tree(4000, 21));
  }
  void TearDown() override { stage_.reset(); }

  ui::SegmentCounts draw(ui::HybridMethod& method) {
    return stage_->draw(method, stage_->scene(stage_->whole())).account;
  }

  std::optional<VesselStage> stage_;
};

// Draws nothing and counts what it was given.
class CountingShare final : public ui::GlShare {
  hal::Result<ui::SegmentCounts> do_draw(const ui::VesselScene& scene,
                                         const ui::VesselSplit& split) override {
    ui::SegmentCounts account;
    for (std::size_t i = 0; i < split.size(); ++i)
      account.drawn += static_cast<std::uint64_t>(split[i] - scene.tree.clusters[i].references);
    return account;
  }
};

TEST_F(HybridMethod, accounts_for_every_segment_whoever_has_it) {
  for (const float radius_px : {0.0F, 0.5F, 2.0F, std::numeric_limits<float>::infinity()}) {
    auto method = ui::HybridMethod::create(1, {}, {std::make_unique<CountingShare>(), radius_px});
    ASSERT_TRUE(method) << method.error().message;
    method->set_detail_px(0.2F);
    const ui::SegmentCounts account = draw(*method);
    EXPECT_EQ(account.total(), stage_->tree().segments) << radius_px;
    if (radius_px <= 0) {
      EXPECT_EQ(account.drawn, stage_->tree().segments);
    } else if (std::isinf(radius_px)) {
      EXPECT_EQ(account.drawn, 0U);
    } else {
      EXPECT_GT(account.drawn, 0U);
      EXPECT_GT(account.splatted, 0U);
    }
  }
}

} // namespace
} // namespace octascope::tests
