#include <fstream>

#include <gmock/gmock.h>

#include "hal/linux/gpio/gpio_lookup.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::hal::linux_backend {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using tests::FailsWith;

GpioSurvey two_chips() {
  return {{{"/dev/gpiochip0", "pinctrl-a", {{0, "LED", "", false}, {1, "", "sysfs", true}}},
           {"/dev/gpiochip10",
            "expander",
            {{0, "trigger", "", false}, {1, "LED", "", false}, {2, "held", "pump", true}}}},
          {}};
}

TEST(GpioLookup, a_name_that_one_line_has_is_found) {
  EXPECT_EQ(find_gpio_line(two_chips(), "trigger").value(),
            (GpioLineAddress{"/dev/gpiochip10", 0}));
}

TEST(GpioLookup, chip_and_offset_are_taken_as_they_are) {
  EXPECT_EQ(find_gpio_line(two_chips(), "gpiochip0:1").value(),
            (GpioLineAddress{"/dev/gpiochip0", 1}));
  EXPECT_EQ(find_gpio_line(two_chips(), "gpiochip10:2").value(),
            (GpioLineAddress{"/dev/gpiochip10", 2}));
}

void expect_refusal(const GpioSurvey& survey, std::string_view wanted, ErrorCode fault,
                    std::string_view message) {
  EXPECT_THAT(find_gpio_line(survey, wanted), FailsWith(fault, std::string{message}));
}

TEST(GpioLookup, nothing_is_guessed) {
  expect_refusal(two_chips(), "LED", ErrorCode::invalid_argument, "gpiochip0:0 and gpiochip10:1");
  expect_refusal(two_chips(), "", ErrorCode::invalid_argument, "empty");
  expect_refusal(two_chips(), "Trigger", ErrorCode::absent, "pinctrl-a, 2 lines");
  expect_refusal(two_chips(), "gpiochip1:0", ErrorCode::absent, "gpiochip1:0");
  expect_refusal(two_chips(), "gpiochip0:2", ErrorCode::invalid_argument, "0 to 1");
  for (const char* const odd : {"gpiochip0:", "gpiochip:1", "gpiochip0:-1", "gpiochip0:1x",
                                "gpiochipx:1", "gpiochip0:99999999999999999999"})
    expect_refusal(two_chips(), odd, ErrorCode::absent, odd);
  expect_refusal({}, "trigger", ErrorCode::absent, "no GPIO chip");
}

TEST(GpioLookup, a_chip_that_may_not_be_asked_may_be_the_one) {
  GpioSurvey survey = two_chips();
  survey.complaints = {"/dev/gpiochip3: permission denied"};
  expect_refusal(survey, "elsewhere", ErrorCode::denied, "/dev/gpiochip3: permission denied");
  EXPECT_TRUE(find_gpio_line(survey, "trigger"));
}

TEST(GpioLookup, lists_lines_by_number_and_name) {
  const GpioSurvey survey = two_chips();
  EXPECT_EQ(listed_lines(survey.chips[0]), "0 LED, 1 without a name");
  EXPECT_EQ(listed_lines(survey.chips[1]), "0 trigger, 1 LED, 2 held");
  EXPECT_EQ(listed_lines({}), "");
}

TEST(GpioLookup, what_is_wrong_is_said_in_words) {
  EXPECT_EQ(gpio_complaint(two_chips(), "trigger"), "");
  EXPECT_THAT(gpio_complaint(two_chips(), "held"),
              AllOf(HasSubstr("\"pump\""), HasSubstr("gpiochip10:2")));
  EXPECT_THAT(gpio_complaint(two_chips(), "elsewhere"), HasSubstr("octascope devices"));
}

TEST(GpioLookup, what_is_no_chip_is_told_or_passed_over) {
  const tests::ScratchFolder dev;
  EXPECT_TRUE(survey_gpio(dev.path() / "nowhere").chips.empty());
  std::ofstream{dev.path() / "gpiochip0"} << "a plain file";
  std::ofstream{dev.path() / "gpiochip-of-sorts"} << "not even the name";
  const GpioSurvey survey = survey_gpio(dev.path());
  EXPECT_TRUE(survey.chips.empty());
}

} // namespace
} // namespace octascope::hal::linux_backend
