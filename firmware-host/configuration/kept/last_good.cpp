#include "firmware-host/configuration/kept/last_good.h"

#include <system_error>

#include "firmware-host/configuration/configuration_check.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;

namespace {

tl::unexpected<hal::Error> failure(const fs::path& file, const char* action,
                                   const std::error_code& error) {
  return hal::fail(hal::ErrorCode::system, "{}: cannot be {}: {}", file.string(), action,
                   error.message());
}

} // namespace

std::optional<fs::path> LastGood::file() const {
  const fs::path file = link() / ConfigurationBundle::main_file;
  std::error_code error;
  return fs::exists(file, error) ? std::optional{file} : std::nullopt;
}

fs::path LastGood::folder_not_in_use() const {
  std::error_code error;
  const fs::path used = fs::read_symlink(link(), error);
  return state_ / (used == "last-good.a" ? "last-good.b" : "last-good.a");
}

hal::Result<> LastGood::keep(const ConfigurationBundle& bundle) const {
  if (const auto kept = ConfigurationBundle::read(link()); kept && *kept == bundle)
    return {};
  const fs::path folder = folder_not_in_use();
  std::error_code error;
  fs::remove_all(folder, error);
  if (!fs::create_directory(folder, error))
    return failure(folder, "made", error);
  fs::permissions(folder, fs::perms::owner_all, error);
  HAL_CHECK(bundle.write(folder));
  HAL_CHECK(load_whole_configuration(folder / ConfigurationBundle::main_file));
  const fs::path part = state_ / ".last-good.part";
  fs::remove(part, error);
  fs::create_directory_symlink(folder.filename(), part, error);
  if (error)
    return failure(part, "made", error);
  fs::rename(part, link(), error);
  if (error)
    return failure(link(), "put in place", error);
  return pipeline::sync_folder_of(link());
}

} // namespace octascope::firmware_host
