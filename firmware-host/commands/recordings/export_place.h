// Where exported files go and how they are named.
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
  // `extension` as in ".nrrd"; `suffix` comes before it in names within a folder. Creates nothing
  // yet. ErrorCode::invalid_argument: one file for several volumes, another format's extension, or
  // a name already taken by something else.
  static hal::Result<ExportPlace> choose(const std::filesystem::path& out,
                                         const std::string& extension, const std::string& suffix,
                                         std::size_t volumes);

  // The file of the recording's `n`th volume, such as volume-0012.nrrd: names sort in numerical
  // order.
  std::filesystem::path file_of(std::size_t n) const;

  // Makes the folder if it is missing, but not its parent; checks that a file can be made there and
  // that `bytes` fit.
  hal::Result<> prepare(std::uint64_t bytes, std::size_t first);

  // After a failure: removes the folder that prepare() made, if it is empty.
  void remove_empty_folder() const;

private:
  ExportPlace() = default;

  std::filesystem::path file_;   // or
  std::filesystem::path folder_; // with
  std::string ending_;           // of each name
  bool made_folder_ = false;
};

// Checks that `bytes` fit on the disk; the error gives both sizes.
hal::Result<> check_room(const std::filesystem::path& folder, std::uint64_t bytes,
                         std::uint64_t available);

} // namespace octascope::firmware_host
