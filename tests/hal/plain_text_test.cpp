#include <string>

#include <gtest/gtest.h>

#include "hal/plain_text.h"
#include "hal/result.h"

namespace octascope::hal {
namespace {

struct Case {
  std::string text;
  bool plain;
  std::string printable;
};

TEST(PlainText, is_utf8_without_control_characters) {
  const std::vector<Case> cases{
      {"", true, ""},
      {"Jürgen 山田 😀", true, "Jürgen 山田 😀"},
      {"a\x1b[2Jb", false, "a?[2Jb"},
      {"one\ntwo\ttabs\r\n", false, "one?two?tabs??"},
      {std::string("nul\0", 4), false, "nul?"},
      {"delete \x7f", false, "delete ?"},
      {"C1 \xc2\x9b"
       "31m",
       false, "C1 ?31m"}, // a control sequence introducer in one character
      {"no-break space \xc2\xa0", true, "no-break space \xc2\xa0"},
      {"M\xfcller", false, "M?ller"},
      {"cut \xe5\xb1", false, "cut ??"},
      {"overlong \xc0\xaf \xe0\x80\xaf", false, "overlong ?? ???"},
      {"half a pair \xed\xa0\x80", false, "half a pair ???"},
      {"beyond \xf4\x90\x80\x80", false, "beyond ????"},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(is_plain_text(c.text), c.plain) << c.printable;
    EXPECT_EQ(printable(c.text), c.printable);
    EXPECT_TRUE(is_plain_text(printable(c.text)));
  }
}

TEST(PlainText, of_lines_keeps_tabs_and_the_ends_of_lines_only) {
  EXPECT_EQ(printable_lines("a\tb\nc\r\nd\re\x1b"), "a\tb\nc\r\nd?e?");
}

TEST(PlainText, is_shortened_between_characters) {
  EXPECT_EQ(shortened("short"), "short");
  EXPECT_EQ(shortened("ääää", 4), "ää…");
  EXPECT_EQ(shortened("ääää", 5), "ää…");
  EXPECT_EQ(shortened("\x1b[31mred", 40), "?[31mred");
}

TEST(PlainText, is_what_every_error_says) {
  EXPECT_EQ(fail(ErrorCode::bad_data, "found \"{}\"\n", "\x1b[31m\xfc").value().message,
            "found \"?[31m?\"\n");
}

} // namespace
} // namespace octascope::hal
