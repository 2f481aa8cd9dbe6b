#include "firmware-host/configuration/configuration_bundle.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

namespace fs = std::filesystem;

hal::Result<std::string> read_file(const fs::path& file) {
  std::ifstream in{file, std::ios::binary};
  std::ostringstream text;
  if (in)
    text << in.rdbuf();
  if (!in)
    return hal::fail(hal::ErrorCode::absent, "{}: cannot be read: {}", file.string(),
                     std::generic_category().message(errno == 0 ? EIO : errno));
  return text.str();
}

// Is it one that names files in its turn?
bool is_calibration(const Configuration& configuration, const fs::path& file) {
  return configuration.calibration == file ||
         std::ranges::any_of(configuration.objectives, [&](const Objective& objective) {
           return objective.calibration == file;
         });
}

} // namespace

hal::Result<ConfigurationBundle> ConfigurationBundle::gather(const fs::path& configuration) {
  HAL_TRY(const auto document, pipeline::ConfigDocument::load(configuration));
  HAL_TRY(const auto read, read_configuration(document));
  ConfigurationBundle bundle;
  HAL_CHECK(bundle.add_with_its_files(document, main_file, &read));
  return bundle;
}

hal::Result<ConfigurationBundle>
ConfigurationBundle::gather_calibration(const fs::path& calibration) {
  HAL_TRY(const auto document, pipeline::calibration_document(calibration));
  ConfigurationBundle bundle;
  HAL_CHECK(bundle.add_with_its_files(document, "calibration.toml", nullptr));
  return bundle;
}

// Numbers keep files apart that have the same name in different folders. The file's own name stays
// at the end: its extension says what it is.
hal::Result<> ConfigurationBundle::add_with_its_files(const pipeline::ConfigDocument& document,
                                                      const std::string& name,
                                                      const Configuration* configuration) {
  const std::string prefix = configuration != nullptr ? "" : fs::path{name}.stem().string() + "-";
  std::vector<std::string> names;
  for (const pipeline::NamedFile& named : document.named_files()) {
    names.push_back(
        fmt::format("{}{}-{}", prefix, names.size() + 1, named.file.filename().string()));
    if (configuration != nullptr && is_calibration(*configuration, named.file)) {
      HAL_TRY(const auto nested, pipeline::calibration_document(named.file));
      HAL_CHECK(add_with_its_files(nested, names.back(), nullptr));
      continue;
    }
    HAL_TRY(auto content, read_file(named.file));
    files_[names.back()] = std::move(content);
  }
  HAL_TRY(auto text, document.text_naming(names));
  files_[name] = std::move(text);
  return {};
}

hal::Result<ConfigurationBundle> ConfigurationBundle::read(const fs::path& folder) {
  ConfigurationBundle bundle;
  std::error_code error;
  for (fs::directory_iterator entry{folder, error}, end; !error && entry != end;
       entry.increment(error)) {
    HAL_TRY(auto content, read_file(entry->path()));
    bundle.files_[entry->path().filename().string()] = std::move(content);
  }
  if (error)
    return hal::fail(hal::ErrorCode::absent, "{}: cannot be listed: {}", folder.string(),
                     error.message());
  return bundle;
}

hal::Result<> ConfigurationBundle::write(const fs::path& folder) const {
  for (const auto& [name, content] : files_)
    HAL_CHECK(pipeline::write_atomically(folder / name, content));
  return {};
}

} // namespace octascope::firmware_host
