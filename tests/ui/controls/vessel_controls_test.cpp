// Vessels on the knob and the pedal: what of them is shown, and where a loaded tree lies.
#include "tests/ui/controls/controller_stage.h"

namespace octascope::ui {
namespace {

TEST_F(Controller, vessels_are_steered_by_the_knob_where_they_are_shown) {
  actions().set_vessels_loaded(true);
  choose(Action::stereo);
  tread({2});
  EXPECT_EQ(state().selected, Action::vessel_opacity) << "past the parallax";
  turn(-6);
  EXPECT_FLOAT_EQ(state().vessel_opacity, 0.7F);
  tread({2});
  turn(1);
  EXPECT_EQ(state().vessel_colouring, VesselColouring::order);
  EXPECT_EQ(echo(), "orders");
  tread({2});
  turn(5);
  EXPECT_NEAR(state().vessel_nudge.shift_mm[0], 0.1F, 1e-6);
  for (int i = 0; i < 5; ++i)
    tread({2});
  EXPECT_EQ(state().selected, Action::vessel_turn_z);
  turn(-4);
  EXPECT_FLOAT_EQ(state().vessel_nudge.turn_deg[2], -2);
  controller_.handle(press(Key::home));
  EXPECT_TRUE(state().vessel_nudge.any()) << "where vessels lie is no matter of the view";
  EXPECT_FLOAT_EQ(state().vessel_opacity, 0.7F);
  controller_.handle(press('v'));
  tread({2});
  EXPECT_EQ(state().selected, Action::vessels) << "hidden vessels are not steered";
}

TEST_F(Controller, vessels_traced_in_the_volume_cannot_be_moved) {
  controller_.handle(press('i'));
  EXPECT_TRUE(state().vessel_nudge.any());
  actions().set_vessels_traced();
  EXPECT_FALSE(state().vessel_nudge.any()) << "what was left";
  for (const char key : {'i', 'j', 'k', 'u', 'y', 'z'})
    controller_.handle(press(static_cast<std::uint16_t>(key)));
  EXPECT_FALSE(state().vessel_nudge.any());
  choose(Action::vessel_opacity);
  tread({2});
  EXPECT_EQ(state().selected, Action::vessel_colours);
  tread({2});
  EXPECT_EQ(state().selected, Action::vessel_account) << "past what moves them";
}

TEST_F(Controller, the_vessels_place_is_kept_or_undone_by_a_turn_to_the_right) {
  EXPECT_FALSE(controller_.handle(press('m')).keep_registration);
  EXPECT_EQ(echo(), "none loaded");
  actions().set_vessels_loaded(true);
  EXPECT_FALSE(controller_.handle(press('m')).keep_registration);
  EXPECT_EQ(echo(), "not moved");
  const VesselNudge none;
  choose(Action::keep_registration);
  controller_.handle(press('k', true));
  const VesselNudge moved = state().vessel_nudge;
  EXPECT_NE(moved, none);
  EXPECT_FALSE(turn(-1).keep_registration);
  EXPECT_EQ(echo(), "turn right to do it");
  EXPECT_TRUE(turn(1).keep_registration);
  EXPECT_EQ(state().vessel_nudge, moved) << "until the host has kept it";
  actions().forget_nudge();
  EXPECT_FALSE(turn(1).keep_registration) << "once is enough";
  controller_.handle(press('u'));
  controller_.handle(press('g'));
  EXPECT_EQ(state().vessel_nudge, none);
  EXPECT_EQ(echo(), "as it was registered");
}

TEST_F(Controller, of_flow_and_a_tree_either_or_both_are_shown) {
  actions().set_vessels_loaded(true);
  actions().set_flow_there(true);
  std::vector<std::pair<VesselsShown, std::string>> seen;
  for (int i = 0; i < 4; ++i) {
    controller_.handle(press('v'));
    seen.emplace_back(state().vessels, echo());
  }
  EXPECT_EQ(seen, (std::vector<std::pair<VesselsShown, std::string>>{
                      {VesselsShown::off, "hidden"},
                      {VesselsShown::flow, "flow"},
                      {VesselsShown::tree, "tree"},
                      {VesselsShown::both, "flow and tree"}}));
  choose(Action::vessels);
  turn(-1);
  EXPECT_EQ(state().vessels, VesselsShown::tree);
  actions().set_vessels_loaded(false);
  turn(1);
  EXPECT_EQ(echo(), "flow, no tree there");
  turn(-1);
  EXPECT_EQ(echo(), "tree: none there");
}

TEST_F(Controller, without_flow_vessels_are_shown_or_hidden) {
  actions().set_vessels_loaded(true);
  controller_.handle(press('v'));
  EXPECT_EQ(state().vessels, VesselsShown::off);
  controller_.handle(press('v'));
  EXPECT_EQ(state().vessels, VesselsShown::both) << "flow, too, where some comes later";
  EXPECT_EQ(echo(), "shown");
}

} // namespace
} // namespace octascope::ui
