#include <random>

#include <drm_fourcc.h>
#include <drm_mode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/kms/mode/output_choice.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

using namespace hal::linux_backend::kms;
using testing::ElementsAre;
using testing::IsEmpty;

Connector connector_of(std::uint32_t id, std::string name, ConnectionStatus status,
                       std::uint32_t crtcs = 1) {
  Connector connector;
  connector.id = id;
  connector.name = std::move(name);
  connector.status = status;
  connector.possible_crtcs = crtcs;
  if (status != ConnectionStatus::disconnected)
    connector.modes.push_back(computed_mode(1920, 1080, 60));
  return connector;
}

Plane plane_of(std::uint32_t id, PlaneKind kind, std::uint32_t crtcs) {
  Plane plane;
  plane.id = id;
  plane.kind = kind;
  plane.possible_crtcs = crtcs;
  return plane;
}

// A graphics device with two CRTCs (ids 40, 41), a primary plane each (30, 31) and three sockets.
Card card_of(const std::string& node = "/dev/dri/card0") {
  Card card;
  card.node = node;
  card.driver = "i915";
  card.atomic = true;
  card.crtcs = {40, 41};
  card.planes = {plane_of(29, PlaneKind::cursor, 3), plane_of(30, PlaneKind::primary, 1),
                 plane_of(31, PlaneKind::primary, 2)};
  card.connectors = {connector_of(50, "DP-1", ConnectionStatus::disconnected, 3),
                     connector_of(51, "HDMI-A-1", ConnectionStatus::connected, 3),
                     connector_of(52, "HDMI-A-2", ConnectionStatus::connected, 2)};
  return card;
}

TEST(OutputChoice, takes_the_first_monitor) {
  const std::vector<Card> cards{card_of()};
  const auto choice = choose_output(cards, {});
  ASSERT_TRUE(choice) << choice.error().message;
  EXPECT_EQ(choice->card, 0U);
  EXPECT_EQ(choice->connector, 1U);
  EXPECT_EQ(choice->crtc, 40U);
  EXPECT_EQ(choice->plane, 30U);
  EXPECT_TRUE(choice->atomic);
  EXPECT_EQ(choice->mode.width, 1920);
}

TEST(OutputChoice, takes_the_named_one_on_the_crtc_that_reaches_it) {
  std::vector<Card> cards{card_of(), card_of("/dev/dri/card1")};
  const auto second = choose_output(cards, {"HDMI-A-2", {}, true});
  ASSERT_TRUE(second);
  EXPECT_EQ(second->card, 0U);
  EXPECT_EQ(second->connector, 2U);
  EXPECT_EQ(second->crtc, 41U);
  EXPECT_EQ(second->plane, 31U);
  const auto other_card = choose_output(cards, {"card1:HDMI-A-1", {}, true});
  ASSERT_TRUE(other_card);
  EXPECT_EQ(other_card->card, 1U);
  EXPECT_EQ(other_card->connector, 1U);
}

TEST(OutputChoice, keeps_what_is_on_already) {
  std::vector<Card> cards{card_of()};
  cards[0].connectors[1].current_crtc = 41;
  EXPECT_EQ(choose_output(cards, {})->crtc, 41U);
  EXPECT_EQ(choose_output(cards, {})->plane, 31U);
}

TEST(OutputChoice, leaves_other_monitors_their_crtc) {
  std::vector<Card> cards{card_of()};
  cards[0].connectors[2].current_crtc = 40;
  EXPECT_EQ(choose_output(cards, {})->crtc, 41U);
  cards[0].connectors[0].current_crtc = 41; // none is free: any is better than none
  EXPECT_EQ(choose_output(cards, {})->crtc, 40U);
}

TEST(OutputChoice, goes_on_with_the_next_card_where_the_first_only_computes) {
  std::vector<Card> cards{Card{}, card_of("/dev/dri/card1")};
  cards[0].node = "/dev/dri/card0";
  cards[0].problem = hal::Error{hal::ErrorCode::unsupported, "only computes"};
  EXPECT_EQ(choose_output(cards, {})->card, 1U);
}

TEST(OutputChoice, uses_the_older_calls_where_there_is_no_other_way) {
  std::vector<Card> cards{card_of()};
  EXPECT_FALSE(choose_output(cards, {"", {}, false})->atomic);
  cards[0].planes.clear();
  const auto choice = choose_output(cards, {});
  EXPECT_FALSE(choice->atomic);
  EXPECT_EQ(choice->plane, 0U);
  cards = {card_of()};
  cards[0].atomic = false;
  EXPECT_FALSE(choose_output(cards, {})->atomic);
}

TEST(OutputChoice, takes_a_socket_that_cannot_tell_only_when_no_other_has_a_monitor) {
  std::vector<Card> cards{card_of()};
  cards[0].connectors[0] = connector_of(50, "VGA-1", ConnectionStatus::unknown, 3);
  EXPECT_EQ(choose_output(cards, {})->connector, 1U);
  cards[0].connectors[1].status = ConnectionStatus::disconnected;
  cards[0].connectors[2].status = ConnectionStatus::disconnected;
  EXPECT_EQ(choose_output(cards, {})->connector, 0U);
  cards[0].connectors[0].modes.clear();
  EXPECT_FALSE(choose_output(cards, {}));
}

TEST(OutputChoice, never_takes_a_writeback_socket) {
  std::vector<Card> cards{card_of()};
  cards[0].connectors[1].writeback = true;
  EXPECT_EQ(choose_output(cards, {})->connector, 2U);
  cards[0].connectors.resize(2);
  EXPECT_FALSE(choose_output(cards, {}));
}

TEST(OutputChoice, says_what_is_missing) {
  using hal::ErrorCode;
  const auto choose = [](const std::vector<Card>& cards, const std::string& name = {}) {
    return choose_output(cards, {name, {}, true});
  };
  EXPECT_THAT(choose({}), FailsWith(ErrorCode::absent, "lspci", "offscreen"));

  std::vector<Card> cards{Card{}};
  EXPECT_THAT(choose(cards), FailsWith(ErrorCode::absent, "no sockets"));
  const hal::Error denied{ErrorCode::denied, "/dev/dri/card0: opening failed"};
  cards[0].problem = denied;
  const auto refused = choose(cards);
  ASSERT_THAT(refused, FailsWith(denied.code));
  EXPECT_EQ(refused.error().message, denied.message);

  cards = {card_of()};
  EXPECT_THAT(choose(cards, "DP-9"),
              FailsWith(ErrorCode::absent, "\"DP-9\"", "card0:DP-1 (disconnected)",
                        "card0:HDMI-A-1 (connected)"));
  EXPECT_THAT(choose(cards, "DP-1"), FailsWith(ErrorCode::absent, "at DP-1", "cable"));

  cards[0].connectors[1].possible_crtcs = 0;
  EXPECT_THAT(choose(cards), FailsWith(ErrorCode::unsupported, "expected a CRTC"));
}

TEST(OutputChoice, names_the_socket_whose_mode_is_not_to_be_had) {
  const std::vector<Card> cards{card_of()};
  const auto choice = choose_output(cards, {"", {800, 600, {}}, true});
  ASSERT_THAT(choice, FailsWith(hal::ErrorCode::unsupported, "HDMI-A-1", "1920x1080"));
}

TEST(Formats, are_those_that_both_can_without_alpha_first) {
  Plane plane;
  plane.formats = {DRM_FORMAT_RGB565, DRM_FORMAT_ARGB8888, DRM_FORMAT_XRGB8888};
  const std::vector<std::uint32_t> drawable{DRM_FORMAT_ARGB8888, DRM_FORMAT_XBGR8888,
                                            DRM_FORMAT_XRGB8888};
  EXPECT_THAT(common_formats(&plane, drawable),
              ElementsAre(DRM_FORMAT_XRGB8888, DRM_FORMAT_ARGB8888));
  EXPECT_THAT(common_formats(nullptr, drawable), ElementsAre(DRM_FORMAT_XRGB8888));
  plane.formats = {DRM_FORMAT_RGB565};
  EXPECT_THAT(common_formats(&plane, drawable), IsEmpty());
}

TEST(Modifiers, are_named_only_where_they_are_known) {
  Card card;
  Plane plane;
  plane.modifiers = {{DRM_FORMAT_XRGB8888, DRM_FORMAT_MOD_INVALID},
                     {DRM_FORMAT_XRGB8888, DRM_FORMAT_MOD_LINEAR},
                     {DRM_FORMAT_XRGB8888, I915_FORMAT_MOD_X_TILED},
                     {DRM_FORMAT_ARGB8888, I915_FORMAT_MOD_Y_TILED}};
  EXPECT_THAT(usable_modifiers(card, &plane, DRM_FORMAT_XRGB8888), IsEmpty()) << "no capability";
  card.modifiers = true;
  EXPECT_THAT(usable_modifiers(card, &plane, DRM_FORMAT_XRGB8888),
              ElementsAre(DRM_FORMAT_MOD_LINEAR, I915_FORMAT_MOD_X_TILED));
  EXPECT_THAT(usable_modifiers(card, nullptr, DRM_FORMAT_XRGB8888), IsEmpty());
}

// Topologies as no machine has them.
class RandomCards {
public:
  explicit RandomCards(std::uint64_t seed) : random_{seed} {}

  std::vector<Card> next() {
    std::vector<Card> cards(below(4));
    for (std::size_t c = 0; c < cards.size(); ++c) {
      Card& card = cards[c];
      card.node = "/dev/dri/card" + std::to_string(c);
      card.atomic = below(2) == 0;
      if (below(5) == 0) {
        card.problem = hal::Error{hal::ErrorCode::denied, "denied"};
        continue;
      }
      for (std::size_t i = below(5); i > 0; --i)
        card.crtcs.push_back(1 + static_cast<std::uint32_t>(below(6)));
      for (std::size_t i = below(6); i > 0; --i)
        card.planes.push_back(plane());
      for (std::size_t i = below(6); i > 0; --i)
        card.connectors.push_back(connector());
    }
    return cards;
  }

  std::size_t below(std::size_t end) { return random_() % end; }

private:
  std::uint32_t mask() { return static_cast<std::uint32_t>(below(3) == 0 ? random_() : below(32)); }

  Plane plane() {
    Plane plane = plane_of(static_cast<std::uint32_t>(10 + below(90)),
                           static_cast<PlaneKind>(below(4)), mask());
    plane.current_crtc = static_cast<std::uint32_t>(below(7));
    return plane;
  }

  Connector connector() {
    Connector result;
    result.id = static_cast<std::uint32_t>(100 + below(50));
    result.name = "HDMI-A-" + std::to_string(below(4));
    result.status = static_cast<ConnectionStatus>(below(3));
    result.writeback = below(8) == 0;
    result.current_crtc = static_cast<std::uint32_t>(below(7));
    result.possible_crtcs = mask();
    for (std::size_t i = below(4); i > 0; --i)
      result.modes.push_back(
          computed_mode(static_cast<int>(8 + below(3000)), static_cast<int>(8 + below(2000)), 60));
    if (below(6) == 0)
      result.modes.emplace_back();
    return result;
  }

  std::mt19937_64 random_;
};

// What is chosen fits together; where nothing is, the words say why.
TEST(OutputChoice, of_any_topology_fits_together) {
  RandomCards random{42};
  int chosen = 0;
  for (int i = 0; i < 50000; ++i) {
    const std::vector<Card> cards = random.next();
    OutputRequest wanted;
    if (random.below(3) == 0)
      wanted.connector = "HDMI-A-" + std::to_string(random.below(5));
    const auto choice = choose_output(cards, wanted);
    if (!choice) {
      ASSERT_FALSE(choice.error().message.empty());
      continue;
    }
    ++chosen;
    ASSERT_LT(choice->card, cards.size());
    const Card& card = cards[choice->card];
    ASSERT_FALSE(card.problem);
    ASSERT_LT(choice->connector, card.connectors.size());
    const Connector& connector = card.connectors[choice->connector];
    ASSERT_NE(connector.status, ConnectionStatus::disconnected);
    ASSERT_FALSE(connector.writeback);
    ASSERT_TRUE(wanted.connector.empty() || connector.name == wanted.connector);
    ASSERT_GT(refresh_hz(choice->mode), 0);
    bool reached = false;
    for (std::size_t c = 0; c < card.crtcs.size(); ++c)
      reached |= card.crtcs[c] == choice->crtc && (connector.possible_crtcs >> c & 1U) != 0;
    ASSERT_TRUE(reached);
    const Plane* const plane = find_plane(card, choice->plane);
    ASSERT_TRUE(choice->plane == 0 || plane != nullptr);
    ASSERT_FALSE(choice->atomic && choice->plane == 0);
  }
  EXPECT_GT(chosen, 5000);
}

} // namespace
} // namespace octascope::tests
