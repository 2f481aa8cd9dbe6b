// What the display says of vessels and their trees, in words.
#include <gmock/gmock.h>

#include "tests/ui/support/hud_words.h"
#include "tests/ui/support/renderer_stage.h"
#include "ui/hud/hud.h"

namespace octascope::tests {
namespace {

using namespace ui;

TEST(HudText, branches_are_named_in_the_hearts_arteries_only) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  const auto named = [&](std::array<bool, pipeline::vessel_branch_count> branches) {
    status.vessels.branches = branches;
    return compose_hud_text({}, status, {}).vessels.branches;
  };
  constexpr std::array<bool, pipeline::vessel_branch_count> none{};
  for (const auto& generic : {std::array{true, false, false, false},
                              {false, false, false, true},
                              {true, false, false, true},
                              {false, true, true, false}})
    EXPECT_EQ(named(generic), none);
  EXPECT_EQ(named({false, true, true, true}), (std::array{false, true, true, true}));
  EXPECT_EQ(named({true, true, true, true}), (std::array{true, true, true, true}));
}

TEST(HudText, vessels_say_how_well_they_were_registered) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  const auto told = [&](const ViewState& view = {}) {
    return std::string{compose_hud_text(view, status, {}).vessels.registration.view()};
  };
  status.vessels.residual_mm = 0.0123;
  EXPECT_EQ(told(), "") << "not registered";
  status.vessels.registered = true;
  EXPECT_EQ(told(), "residual 12 µm");
  status.vessels.residual_mm = 2160.2284;
  EXPECT_EQ(told(), "residual 2160 mm");
  ViewState moved;
  moved.vessel_nudge.turn_deg[1] = 0.5F;
  EXPECT_EQ(told(moved), "adjusted by hand");
  status.vessels.residual_mm.reset();
  EXPECT_EQ(told(), "residual unknown");
}

TEST(HudText, a_tree_that_is_followed_says_its_overlap_or_that_it_does_not_match) {
  using State = FollowedTreeStatus::State;
  Status status = live_status();
  const auto told = [&](const ViewState& view = {}) {
    return compose_hud_text(view, status, {}).vessels;
  };
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.registered = true;
  status.vessels.residual_mm = 0.0143;
  status.vessels.followed = FollowedTreeStatus{State::followed, 0.917, {}};
  EXPECT_EQ(told().registration.view(), "residual 14 µm, overlap 91 %");
  EXPECT_EQ(told().tree.view(), "");
  // Where somebody said that it lies, it stays, and is marked.
  status.vessels.followed = FollowedTreeStatus{State::unmatched, 0, {}};
  EXPECT_TRUE(told().shown);
  EXPECT_EQ(told().tree.view(), "vessels do not match");
  EXPECT_TRUE(told().tree_old);
  // Nowhere else: it is not drawn.
  status.vessels.state = VesselStatus::State::none;
  EXPECT_FALSE(told().shown);
  EXPECT_EQ(told().tree.view(), "vessels do not match");
  const HudText hud = compose_hud_text({}, status, {});
  ASSERT_GT(hud.trouble_count, 0U);
  EXPECT_EQ(hud.troubles[hud.trouble_count - 1].words.view(), "vessels do not match");
  status.vessels.followed = FollowedTreeStatus{};
  EXPECT_EQ(told().tree.view(), "vessels not placed yet");
  EXPECT_FALSE(told().tree_old);
  ViewState hidden;
  hidden.vessels = VesselsShown::off;
  EXPECT_EQ(told(hidden).tree.view(), "") << "nobody wants to see them";
}

TEST(HudText, flow_that_cannot_be_drawn_is_said) {
  ShownPictures shown;
  shown.flow.refused = true;
  const HudText hud = compose_hud_text({}, live_status(), shown);
  ASSERT_GT(hud.trouble_count, 0U);
  EXPECT_EQ(hud.troubles[0].words.view(), "flow cannot be drawn");
}

TEST(HudText, a_tree_that_was_not_registered_for_long_is_marked_with_its_age) {
  using Followed = FollowedTreeStatus;
  Status status = live_status();
  const auto told = [&] { return compose_hud_text({}, status, {}).vessels; };
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.registered = true;
  status.vessels.residual_mm = 0.0143;
  status.vessels.followed = Followed{Followed::State::followed, 0.917,
                                     Followed::old_after - std::chrono::milliseconds{1}};
  EXPECT_EQ(told().tree.view(), "");
  status.vessels.followed->age = Followed::old_after;
  EXPECT_EQ(told().tree.view(), "vessels placed 3 s ago");
  EXPECT_TRUE(told().tree_old);
  EXPECT_EQ(told().registration.view(), "residual 14 µm, overlap 91 %");
  status.vessels.followed = Followed{Followed::State::removed, 0, std::chrono::seconds{32}};
  EXPECT_EQ(told().tree.view(), "vessels as placed by hand");
  status.vessels.state = VesselStatus::State::none;
  EXPECT_EQ(told().tree.view(), "no vessels: placed 32 s ago");
  const HudText hud = compose_hud_text({}, status, {});
  ASSERT_GT(hud.trouble_count, 0U);
  EXPECT_EQ(hud.troubles[hud.trouble_count - 1].words.view(), "no vessels: placed 32 s ago");
}

TEST(HudText, a_tree_that_is_old_is_marked_and_one_that_is_not_drawn_has_its_reason) {
  using State = TracedTreeStatus::State;
  using Words = std::vector<std::string>;
  Status status = live_status();
  const auto told = [&](const ViewState& view = {}) {
    return compose_hud_text(view, status, {}).vessels;
  };
  EXPECT_EQ(told().tree.view(), "");
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.registered = true;
  status.vessels.traced = TracedTreeStatus{.state = State::shown,
                                           .age = std::chrono::milliseconds{999},
                                           .vessels = 12,
                                           .length_mm = 8.34,
                                           .refusal = {}};
  EXPECT_EQ(told().tree.view(), "tree < 1 s old, 12 vessels, 8.3 mm");
  EXPECT_EQ(told().registration.view(), "") << "it was traced where it is";
  EXPECT_FALSE(told().tree_old);
  EXPECT_EQ(troubles_of(status), Words{});
  status.vessels.traced->age = TracedTreeStatus::old_after - std::chrono::milliseconds{1};
  EXPECT_EQ(told().tree.view(), "tree 2 s old, 12 vessels, 8.3 mm");
  EXPECT_FALSE(told().tree_old);
  status.vessels.traced->age = TracedTreeStatus::old_after;
  EXPECT_TRUE(told().tree_old);
  EXPECT_EQ(troubles_of(status), Words{"tree 3 s old"});
  ViewState hidden;
  hidden.vessels = VesselsShown::off;
  EXPECT_EQ(told(hidden).tree.view(), "");

  status.vessels.state = VesselStatus::State::none;
  status.vessels.traced->state = State::removed;
  status.vessels.traced->age = std::chrono::seconds{75};
  EXPECT_EQ(told().tree.view(), "no tree: the last is 75 s old");
  EXPECT_FALSE(told().shown);
  EXPECT_EQ(troubles_of(status), Words{"no vessel tree"});
  status.vessels.traced->state = State::refused;
  status.vessels.traced->refusal = "no vessel was found";
  EXPECT_EQ(told().tree.view(), "no tree: no vessel was found");
  EXPECT_EQ(troubles_of(status), Words{"no vessel tree"});
}

TEST(HudText, merged_vessels_and_their_account_are_told) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.account = {1, 20, 300, 4000};
  ViewState view;
  EXPECT_FALSE(compose_hud_text(view, status, {}).vessels.account) << "on request";
  view.vessel_account = true;
  EXPECT_EQ(compose_hud_text(view, status, {}).vessels.account->total(), 4321U);
  EXPECT_EQ(compose_hud_text(view, status, {}).facts[2].view(), "thinnest vessels merged");
  status.reduced_quality = 0.5F;
  EXPECT_EQ(compose_hud_text(view, status, {}).facts[2].view(),
            "quality reduced to 50 %, thinnest vessels merged");
  status.vessels.account.merged = 0;
  EXPECT_EQ(compose_hud_text(view, status, {}).facts[2].view(), "quality reduced to 50 %");
}

TEST(HudText, vessels_that_a_flat_picture_leaves_out_are_told) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  ShownPictures shown;
  shown.vessels_left_out = true;
  ViewState view;
  EXPECT_EQ(compose_hud_text(view, status, shown).facts[2].view(), "thinnest vessels left out");
  status.vessels.account.merged = 3;
  EXPECT_EQ(compose_hud_text(view, status, shown).facts[2].view(),
            "thinnest vessels merged or left out");
  view.vessels = VesselsShown::flow;
  EXPECT_EQ(compose_hud_text(view, status, shown).facts[2].view(), "");
}

} // namespace
} // namespace octascope::tests
