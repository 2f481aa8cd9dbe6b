#include "firmware-host/report/run_outputs.h"

#include <array>
#include <filesystem>
#include <string_view>

#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

struct NamedFile {
  std::string_view name; // as the user said it
  std::optional<std::filesystem::path> file;
};

// Two names of one file, also through links and other folders.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::weakly_canonical(a, error) == std::filesystem::weakly_canonical(b, error);
}

// None may be written over another; and least of all over a recording.
hal::Result<> check_apart(const RunOptions& options) {
  const std::array<NamedFile, 4> files{
      {{"--snapshot", options.snapshot},
       {"--report", options.report},
       {"--out", options.record_to},
       {"the recording", options.replay ? std::optional{options.replay->file} : std::nullopt}}};
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (files[i].file && files[j].file && same_file(*files[i].file, *files[j].file))
        return hal::fail(hal::ErrorCode::invalid_argument,
                         "{} and {} are both {}, expected two files: give one of them another name",
                         files[j].name, files[i].name, files[i].file->string());
  return {};
}

} // namespace

hal::Result<> check_outputs(const RunOptions& options) {
  for (const auto& file : {options.snapshot, options.report}) {
    if (!file)
      continue;
    HAL_CHECK(pipeline::AtomicFile::create(*file));
  }
  return check_apart(options);
}

hal::Result<> leave_snapshot(const RunOptions& options,
                             const std::optional<pipeline::Image>& picture) {
  if (!options.snapshot)
    return {};
  if (!picture)
    return hal::fail(hal::ErrorCode::absent, "{}: not written: the display was gone at the end",
                     options.snapshot->string());
  HAL_CHECK(pipeline::write_png(*options.snapshot, *picture));
  fmt::print("snapshot: {}\n", options.snapshot->string());
  return {};
}

} // namespace octascope::firmware_host
