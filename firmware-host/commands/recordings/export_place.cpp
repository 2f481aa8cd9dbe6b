#include "firmware-host/commands/recordings/export_place.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "firmware-host/commands/size_text.h"
#include "pipeline/files/atomic_file.h"
#include "pipeline/files/file_name.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

constexpr std::array<std::string_view, 4> known_extensions{".nrrd", ".dcm", ".png", ".h5"};

bool is_other_format(const fs::path& out, const std::string& extension) {
  const std::string found = pipeline::file_ending(out);
  return found != extension && std::ranges::find(known_extensions, found) != known_extensions.end();
}

} // namespace

hal::Result<> check_room(const fs::path& folder, std::uint64_t bytes, std::uint64_t available) {
  if (bytes <= available)
    return {};
  return hal::fail(
      ErrorCode::system,
      "{}: found {} free, expected {} for the files; fewer volumes (--volumes) or another disk",
      folder.string(), size_words(available), size_words(bytes));
}

hal::Result<ExportPlace> ExportPlace::choose(const fs::path& out, const std::string& extension,
                                             const std::string& suffix, std::size_t volumes) {
  std::error_code error;
  const fs::file_status status = fs::status(out, error);
  ExportPlace place;
  if (!fs::is_directory(status) && is_other_format(out, extension))
    return hal::fail(ErrorCode::invalid_argument,
                     "--out is {}, expected a name ending with {}, or a folder", out.string(),
                     extension);
  if (!fs::is_directory(status) && pipeline::file_ending(out) == extension) {
    if (volumes != 1)
      return hal::fail(
          ErrorCode::invalid_argument,
          "--out is {}, one file for {} volumes; expected a folder, or one volume (--volumes N)",
          out.string(), volumes);
    place.file_ = out;
    return place;
  }
  if (fs::exists(status) && !fs::is_directory(status))
    return hal::fail(ErrorCode::invalid_argument,
                     "--out is {}, which is a file; expected a folder, or a name ending with {}",
                     out.string(), extension);
  place.folder_ = out;
  place.ending_ = suffix + extension;
  return place;
}

fs::path ExportPlace::file_of(std::size_t n) const {
  return folder_.empty() ? file_ : folder_ / fmt::format("volume-{:04}{}", n, ending_);
}

hal::Result<> ExportPlace::prepare(std::uint64_t bytes, std::size_t first) {
  std::error_code error;
  if (!folder_.empty()) {
    made_folder_ = fs::create_directory(folder_, error);
    if (error)
      return hal::fail(error == std::errc::permission_denied ? ErrorCode::denied
                                                             : ErrorCode::absent,
                       "{}: the folder cannot be made: {}", folder_.string(), error.message());
  }
  const fs::path file = file_of(first);
  HAL_CHECK(pipeline::AtomicFile::create(file));
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path{"."};
  const fs::space_info space = fs::space(folder, error);
  return error ? hal::Result<>{} : check_room(folder, bytes, space.available);
}

void ExportPlace::remove_empty_folder() const {
  std::error_code not_empty;
  if (made_folder_)
    fs::remove(folder_, not_empty);
}

} // namespace octascope::firmware_host
