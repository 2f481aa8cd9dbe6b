// Reports when the configuration's files are written, or a reload is requested.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

namespace octascope::firmware_host {

enum class ReloadSignal : std::uint8_t {
  heeded,  // SIGHUP, as `systemctl reload` sends it
  ignored, // a closed terminal sends it, too: it ends the program, as usual
};

// Make it before any thread starts: a heeded signal is then blocked in all threads. Ask from one
// thread.
class ConfigurationWatch {
public:
  // Watches the file's folder, so that editors that replace files are noticed. If the folder cannot
  // be watched, or with an empty path, only the signal counts.
  ConfigurationWatch(const std::filesystem::path& file, ReloadSignal signal);
  ~ConfigurationWatch();
  ConfigurationWatch(const ConfigurationWatch&) = delete;
  ConfigurationWatch& operator=(const ConfigurationWatch&) = delete;

  // Adds files named by the configuration that lie in the same folder.
  void watch_too(const std::filesystem::path& file);

  // Never blocks. True once after each change.
  bool changed();

private:
  bool signal_came() const;
  bool file_was_written();

  std::filesystem::path folder_;
  std::set<std::string> names_; // files in the folder that are watched
  int notify_ = -1;
  int signals_ = -1;
};

} // namespace octascope::firmware_host
