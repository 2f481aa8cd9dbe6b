#include <gtest/gtest.h>

#include "ui/view/action_table.h"

namespace octascope::ui {
namespace {

TEST(ViewState, clamps_every_value_and_wraps_yaw) {
  ViewState v;
  v.yaw_deg = 370;
  v.tilt_deg = 200;
  v.distance = 0;
  v.window_size_db = 0;
  const ViewState c = v.clamped();
  EXPECT_FLOAT_EQ(c.yaw_deg, 10);
  EXPECT_FLOAT_EQ(c.tilt_deg, 89);
  EXPECT_GT(c.distance, 0);
  EXPECT_GE(c.window_size_db, 1);
}

TEST(ViewState, clamps_the_number_of_every_action) {
  for (const ActionRow& row : action_table())
    if (const Number* number = number_of(row.action))
      for (const float far : {-1e6F, 1e6F}) {
        ViewState v;
        number->set(v, far);
        EXPECT_EQ(number->of(v.clamped()), number->of(v)) << row.name;
        EXPECT_GE(number->of(v), number->range.lowest) << row.name;
        EXPECT_LE(number->of(v), number->range.highest) << row.name;
      }
}

TEST(ViewState, shows_the_same_unless_something_drawn_changed) {
  const ViewState first;
  for (const ActionRow& row : action_table()) {
    ViewState changed;
    std::visit(Overloaded{
                   [](const NoValue&) {},
                   [&](const Number& v) { v.set(changed, v.of(changed) - v.range.detent); },
                   [&](const Flag& v) { changed.*v.flag = !(changed.*v.flag); },
                   [&](const Choice& v) { v.set(changed, v.of(changed) == 0 ? 1 : 0); },
                   [&](const NamedChoice& v) { ++(changed.*v.index); },
               },
               row.value);
    EXPECT_EQ(changed == first, std::holds_alternative<NoValue>(row.value)) << row.name;
    EXPECT_EQ(same_sight(changed, first), !row.has(trait::drawn)) << row.name;
  }
}

} // namespace
} // namespace octascope::ui
