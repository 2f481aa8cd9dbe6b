#include "firmware-host/vessels/vessel_patient_check.h"

#include <fmt/format.h>

namespace octascope::firmware_host {

std::string in_words(const pipeline::PatientEye& whose) {
  const std::string subject =
      whose.subject.empty() ? "a subject not said" : "subject " + whose.subject;
  if (whose.eye == pipeline::Eye::not_said)
    return subject;
  return fmt::format("{}, {} eye", subject, to_string(whose.eye));
}

hal::Result<> check_vessel_patient(const std::filesystem::path& registration,
                                   const pipeline::PatientEye& vessels,
                                   const pipeline::PatientEye& picture) {
  if (may_be_same(vessels, picture))
    return {};
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "{}: [whose] says that the vessels are those of {}, expected those in the "
                   "picture, of {}; take this eye's tree and registration; of a live picture "
                   "--subject and --eye say whose it is",
                   registration.string(), in_words(vessels), in_words(picture));
}

} // namespace octascope::firmware_host
