#include "firmware-host/configuration/kept/configuration_watch.h"

#include <array>
#include <csignal>
#include <cstddef>

#include <sys/inotify.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace octascope::firmware_host {

namespace {

int make_signal_descriptor() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path{"."};
}

} // namespace

ConfigurationWatch::ConfigurationWatch(const std::filesystem::path& file, ReloadSignal signal)
    : folder_{folder_of(file)} {
  if (signal == ReloadSignal::heeded)
    signals_ = make_signal_descriptor();
  if (file.empty())
    return;
  names_.insert(file.filename().string());
  notify_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (notify_ >= 0)
    inotify_add_watch(notify_, folder_.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO);
}

ConfigurationWatch::~ConfigurationWatch() {
  if (notify_ >= 0)
    close(notify_);
  if (signals_ >= 0)
    close(signals_);
}

void ConfigurationWatch::watch_too(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::equivalent(folder_of(file), folder_, error))
    names_.insert(file.filename().string());
}

bool ConfigurationWatch::changed() {
  const bool asked = signal_came();
  return file_was_written() || asked;
}

bool ConfigurationWatch::signal_came() const {
  signalfd_siginfo info{};
  return signals_ >= 0 && read(signals_, &info, sizeof info) == sizeof info;
}

bool ConfigurationWatch::file_was_written() {
  if (notify_ < 0)
    return false;
  bool written = false;
  alignas(inotify_event) std::array<char, 4096> buffer{};
  for (ssize_t got = 0; (got = read(notify_, buffer.data(), buffer.size())) > 0;) {
    for (std::size_t at = 0; at < static_cast<std::size_t>(got);) {
      const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
      written = written || (event->mask & IN_Q_OVERFLOW) != 0 ||
                (event->len > 0 && names_.contains(static_cast<const char*>(event->name)));
      at += sizeof(inotify_event) + event->len;
    }
  }
  return written;
}

} // namespace octascope::firmware_host
