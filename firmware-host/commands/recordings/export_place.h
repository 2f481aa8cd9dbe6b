// Where exported files go, and what they are called.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/result.h"

namespace octascope::firmware_host {

// One file for one volume, or a folder with one for each.
class ExportPlace {
public:
  // `extension` as ".nrrd"; `suffix` comes before it in the names of a folder's files. Makes
  // nothing yet. ErrorCode::invalid_argument: one file for several volumes, another format's
  // extension, a name that is something else already.
  static hal::Result<ExportPlace> choose(const std::filesystem::path& out,
                                         const std::string& extension, const std::string& suffix,
                                         std::size_t volumes);

  // The file of the recording's `n`th volume: volume-0012.nrrd, which sorts as it counts.
  std::filesystem::path file_of(std::size_t n) const;

  // Makes the folder where it is missing, but not the one that it is in; says whether a file can be
  // made there, and whether `bytes` find room.
  hal::Result<> prepare(std::uint64_t bytes, std::size_t first);

  // After a failure: the folder that prepare() made, if there is nothing in it.
  void remove_empty_folder() const;

private:
  ExportPlace() = default;

  std::filesystem::path file_;   // or
  std::filesystem::path folder_; // with
  std::string ending_;           // of each name
  bool made_folder_ = false;
};

// What `bytes` need against what there is, in words for an error.
hal::Result<> check_room(const std::filesystem::path& folder, std::uint64_t bytes,
                         std::uint64_t available);

} // namespace octascope::firmware_host
