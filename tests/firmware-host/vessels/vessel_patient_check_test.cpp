#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/vessels/vessel_patient_check.h"

namespace octascope::firmware_host {
namespace {

using pipeline::Eye;
using pipeline::PatientEye;
using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const PatientEye& vessels, const PatientEye& picture) {
  const auto checked = check_vessel_patient("r.toml", vessels, picture);
  if (checked)
    return "not refused";
  EXPECT_EQ(checked.error().code, hal::ErrorCode::invalid_argument);
  return checked.error().message;
}

TEST(WhoseVessels, of_another_subject_or_eye_are_refused) {
  EXPECT_THAT(refusal({"4711", Eye::left}, {"4712", Eye::left}),
              AllOf(HasSubstr("r.toml: "), HasSubstr("subject 4711, left eye"),
                    HasSubstr("subject 4712, left eye")));
  EXPECT_THAT(refusal({"4711", Eye::left}, {"4711", Eye::right}), HasSubstr("4711, right eye"));
  EXPECT_THAT(refusal({"", Eye::left}, {"4711", Eye::right}),
              HasSubstr("a subject not said, left eye"));
}

TEST(WhoseVessels, contradict_nothing_that_nobody_said) {
  for (const PatientEye& vessels : {PatientEye{}, PatientEye{"4711", Eye::not_said},
                                    PatientEye{"", Eye::left}, PatientEye{"4711", Eye::left}})
    for (const PatientEye& picture : {PatientEye{}, PatientEye{"4711", Eye::left}}) {
      EXPECT_EQ(refusal(vessels, picture), "not refused");
      EXPECT_EQ(refusal(picture, vessels), "not refused");
    }
}

} // namespace
} // namespace octascope::firmware_host
