// What a start learns about reconstruction on this machine, kept for the next one: the times of
// both paths, and FFTW's wisdom.
//
// One JSON file in the user's or the service's cache folder, valid for one build on one processor:
// another version, build or processor starts afresh. Nothing depends on it: what is missing, broken
// or unwritable is measured again.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "hal/result.h"
#include "pipeline/reconstruction/path_choice.h"

namespace octascope::firmware_host {

// $CACHE_DIRECTORY (a systemd service's), else $XDG_CACHE_HOME/octascope, else ~/.cache/octascope;
// empty if none of the three is set. Relative paths are ignored, as the XDG specification demands;
// of several folders in $CACHE_DIRECTORY the first is taken.
std::optional<std::filesystem::path> cache_folder();

// The processor's model as the kernel names it.
std::string processor_name();

// What the cache is valid for: the program's version, the date and size of its file, and the
// processor.
std::string machine_fingerprint();

// One thread, at start-up. Make it before the first Reconstructor, call save() after the last.
class ReconstructionCache final : public pipeline::PathMemory {
public:
  // Reads the file and passes FFTW its wisdom. Empty folder: nothing is kept.
  explicit ReconstructionCache(const std::optional<std::filesystem::path>& folder = cache_folder(),
                               std::string fingerprint = machine_fingerprint());

  std::optional<pipeline::PathTimes> recall(std::string_view line_case) override;
  void remember(std::string_view line_case, const pipeline::PathTimes& times) override;

  // Writes new results, whole or not at all, making the folder if needed. An Error concerns only
  // the doctor; everything works without the file.
  hal::Result<> save();

  // Empty if there is no folder.
  const std::filesystem::path& file() const { return file_; }

private:
  void load();

  std::filesystem::path file_;
  std::string fingerprint_;
  std::map<std::string, pipeline::PathTimes, std::less<>> times_;
  std::string saved_wisdom_;
  bool changed_ = false;
};

} // namespace octascope::firmware_host
