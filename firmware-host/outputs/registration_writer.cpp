#include "firmware-host/outputs/registration_writer.h"

#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "firmware-host/outputs/dated_file.h"
#include "firmware-host/version/version.h"

namespace octascope::firmware_host {

bool RegistrationWriter::keep(const pipeline::RigidTransform& volume_from_tree,
                              pipeline::PatientEye whose, std::string source) {
  pipeline::Registration registration;
  registration.volume_from_tree = volume_from_tree;
  registration.whose = std::move(whose);
  registration.provenance = {
      .program = fmt::format("octascope {}", version()),
      .author = "",
      .created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))),
      .method = "moved by hand on the display",
      .source = std::move(source),
      .points = 0,
      .residual_mm = std::nullopt};
  return writing_.start([registration = std::move(registration),
                         file = free_dated_name(folder_, "registration",
                                                ".toml")]() -> hal::Result<std::filesystem::path> {
    HAL_CHECK(write_registration(registration, file));
    return file;
  });
}

} // namespace octascope::firmware_host
