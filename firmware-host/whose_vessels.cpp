#include "firmware-host/whose_vessels.h"

#include <fmt/format.h>

namespace octascope::firmware_host {

std::string in_words(const pipeline::WhoseEye& whose) {
  const std::string subject =
      whose.subject.empty() ? "a subject not said" : "subject " + whose.subject;
  if (whose.eye == pipeline::Eye::not_said)
    return subject;
  return fmt::format("{}, {} eye", subject, to_string(whose.eye));
}

hal::Result<> check_whose_vessels(const std::filesystem::path& registration,
                                  const pipeline::WhoseEye& vessels,
                                  const pipeline::WhoseEye& picture) {
  if (may_be_same(vessels, picture))
    return {};
  return hal::fail(
      hal::Fault::invalid_argument,
      fmt::format("{}: [whose] says that the vessels are those of {}, expected those in "
                  "the picture, of {}; take this eye's tree and registration; of a live picture "
                  "--subject and --eye say whose it is",
                  registration.string(), in_words(vessels), in_words(picture)));
}

} // namespace octascope::firmware_host
