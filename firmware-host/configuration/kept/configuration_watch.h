// Tells when the configuration's files were written, or when somebody asks for them to be read
// anew.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

namespace octascope::firmware_host {

enum class ReloadSignal : std::uint8_t {
  heeded,  // SIGHUP, as `systemctl reload` sends it
  ignored, // a terminal that is closed sends it, too: it ends the program as ever
};

// Make it before any thread starts: a heeded signal is blocked in all threads from then on. One
// thread asks.
class ConfigurationWatch {
public:
  // The file's folder is watched, so that an editor's way of replacing files is seen; one that
  // cannot be watched is not, and the signal alone serves. An empty path: the signal alone.
  ConfigurationWatch(const std::filesystem::path& file, ReloadSignal signal);
  ~ConfigurationWatch();
  ConfigurationWatch(const ConfigurationWatch&) = delete;
  ConfigurationWatch& operator=(const ConfigurationWatch&) = delete;

  // Files that it names and that lie in the same folder.
  void watch_too(const std::filesystem::path& file);

  // Never waits. True once after something happened.
  bool changed();

private:
  bool signal_came() const;
  bool file_was_written();

  std::filesystem::path folder_;
  std::set<std::string> names_; // of the files in it that count
  int notify_ = -1;
  int signals_ = -1;
};

} // namespace octascope::firmware_host
