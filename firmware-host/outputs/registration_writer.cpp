#include "firmware-host/outputs/registration_writer.h"

#include <chrono>
#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "firmware-host/outputs/dated_file.h"
#include "firmware-host/version/version.h"

namespace octascope::firmware_host {

bool RegistrationWriter::keep(const pipeline::RigidTransform& volume_from_tree,
                              pipeline::PatientEye whose, std::string source) {
  if (writing_.valid())
    return false;
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
  writing_ = std::async(std::launch::async,
                        [registration = std::move(registration),
                         file = free_dated_name(folder_, "registration",
                                                ".toml")]() -> hal::Result<std::filesystem::path> {
                          HAL_CHECK(write_registration(registration, file));
                          return file;
                        });
  return true;
}

std::optional<hal::Result<std::filesystem::path>> RegistrationWriter::take() {
  using namespace std::chrono_literals;
  if (!writing_.valid() || writing_.wait_for(0s) != std::future_status::ready)
    return std::nullopt;
  return writing_.get();
}

} // namespace octascope::firmware_host
