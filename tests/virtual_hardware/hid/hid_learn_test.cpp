// A control that nobody knows is learned, and serves.
#include "hal/linux/hid/learning/learning_session.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/hid/hid_bench.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::ControlModel;
using hal::linux_backend::HidControls;
using hal::linux_backend::HidNode;
using hal::linux_backend::LearningSession;
using namespace std::chrono_literals;

class HidLearn : public HidTest {
protected:
  // As a person would do it: plugs it in, sends the reports, asks what was learned.
  ControlModel learn(VirtualPedalKind kind, std::initializer_list<std::vector<std::uint8_t>> sent) {
    kind.vendor = 0x1234;
    kind.product = 0x5678;
    pedal_ = plug_in(kind);
    std::vector<HidNode> nodes = hal::linux_backend::survey_hid();
    std::erase_if(nodes, [](const HidNode& node) { return node.vendor != 0x1234; });
    auto session = LearningSession::listen_to(nodes);
    EXPECT_TRUE(session) << session.error().message;
    for (const auto& report : sent) {
      EXPECT_TRUE(pedal_->send(report));
      const auto lines = session->listen(1s);
      EXPECT_TRUE(lines && !lines->empty());
    }
    auto model = session->learned();
    EXPECT_TRUE(model);
    return model.value_or(ControlModel{});
  }

  std::unique_ptr<VirtualPedal> pedal_;
};

TEST_F(HidLearn, a_pedal_by_its_bits) {
  const ControlModel model = learn(vec_pedal(), {{0, 2}, {0, 0}, {16, 0}, {0, 0}});
  EXPECT_EQ(model.switches, 2);
  HidControls controls{clock_, {model}};
  ASSERT_TRUE(controls.open());
  EXPECT_TRUE(pedal_->send({0, 2}));
  EXPECT_EQ(read_all(controls), (Moves{pressed(0)}));
  EXPECT_TRUE(pedal_->send({16, 0}));
  EXPECT_EQ(read_all(controls), (Moves{released(0), pressed(1)}));
}

TEST_F(HidLearn, one_that_types_by_its_keys) {
  const std::vector<std::uint8_t> up{1, 0, 0, 0, 0, 0, 0, 0, 0};
  const ControlModel model = learn(
      pcsensor_pedal(), {{1, 0, 0, 0x1d, 0, 0, 0, 0, 0}, up, {1, 0, 0, 0x04, 0, 0, 0, 0, 0}, up});
  EXPECT_TRUE(model.by_evdev());
  EXPECT_EQ(model.keys.size(), 2U);
  HidControls controls{clock_, {model}};
  ASSERT_TRUE(controls.open());
  EXPECT_TRUE(pedal_->send({1, 0, 0, 0x04, 0, 0, 0, 0, 0}));
  EXPECT_EQ(read_all(controls), (Moves{pressed(1)}));
}

TEST_F(HidLearn, one_that_goes_meanwhile_is_told) {
  pedal_ = plug_in(vec_pedal());
  auto session = LearningSession::listen_to(hal::linux_backend::survey_hid());
  ASSERT_TRUE(session);
  pedal_.reset();
  EXPECT_THAT(session->listen(1s), FailsWith(hal::ErrorCode::disconnected));
}

} // namespace
} // namespace octascope::tests
