#include "firmware-host/reconstruction/reconstruction_cache.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/utsname.h>

#include "firmware-host/version/version.h"
#include "pipeline/files/atomic_file.h"
#include "pipeline/reconstruction/fft_plan.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr const char* file_name = "reconstruction.json";
constexpr std::uintmax_t longest_file = 1 << 20; // wisdom takes some kilobytes

std::optional<fs::path> absolute_folder(const char* variable, const fs::path& below) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value != '/')
    return std::nullopt;
  return fs::path{value} / below;
}

std::string read_file(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error); // fails for whatever is no regular file
  if (error || size > longest_file)
    return {};
  std::ifstream in{file, std::ios::binary};
  std::string text(size, '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  return in ? text : std::string{};
}

bool plausible(double ns) {
  return std::isfinite(ns) && ns > 0;
}

} // namespace

std::optional<fs::path> cache_folder() {
  if (const char* service = std::getenv("CACHE_DIRECTORY"); service != nullptr && *service == '/') {
    const std::string_view folders{service};
    return fs::path{folders.substr(0, folders.find(':'))};
  }
  if (auto folder = absolute_folder("XDG_CACHE_HOME", "octascope"))
    return folder;
  return absolute_folder("HOME", ".cache/octascope");
}

std::string processor_name() {
  std::ifstream in{"/proc/cpuinfo"};
  for (std::string line; std::getline(in, line);) {
    for (const std::string_view key : {"model name", "Model"}) { // x86 and some ARM boards
      const auto value = line.find(": ");
      if (line.starts_with(key) && value != std::string::npos)
        return line.substr(value + 2);
    }
  }
  struct utsname names = {};
  return ::uname(&names) == 0 ? names.machine : "unknown";
}

std::string machine_fingerprint() {
  std::error_code error;
  const fs::path program = fs::canonical("/proc/self/exe", error);
  const auto size = fs::file_size(program, error);
  const auto built = fs::last_write_time(program, error).time_since_epoch();
  return fmt::format("octascope {}, {} bytes of {}, on {}", version(), size,
                     std::chrono::duration_cast<std::chrono::seconds>(built).count(),
                     processor_name());
}

ReconstructionCache::ReconstructionCache(const std::optional<fs::path>& folder,
                                         std::string fingerprint)
    : file_(folder ? *folder / file_name : fs::path{}), fingerprint_(std::move(fingerprint)) {
  if (!file_.empty())
    load();
}

// Whatever is not as save() writes it is passed over.
void ReconstructionCache::load() {
  const json root = json::parse(read_file(file_), nullptr, false);
  if (!root.is_object() || !root.contains("written_by") || root["written_by"] != fingerprint_)
    return;
  if (const auto wisdom = root.find("fftw_wisdom");
      wisdom != root.end() && wisdom->is_string() && pipeline::import_fft_wisdom(*wisdom))
    saved_wisdom_ = pipeline::export_fft_wisdom();
  const auto cases = root.find("ns_per_line");
  if (cases == root.end() || !cases->is_object())
    return;
  for (const auto& [line_case, times] : cases->items()) {
    const auto number = [&times = times](const char* key) {
      const auto value = times.is_object() ? times.find(key) : times.end();
      return value != times.end() && value->is_number() ? value->get<double>() : 0.0;
    };
    const pipeline::PathTimes read{number("fused"), number("fftw")};
    if (plausible(read.fused_ns) && plausible(read.fftw_ns))
      times_.insert_or_assign(line_case, read);
  }
}

std::optional<pipeline::PathTimes> ReconstructionCache::recall(std::string_view line_case) {
  const auto found = times_.find(line_case);
  return found == times_.end() ? std::nullopt : std::optional{found->second};
}

void ReconstructionCache::remember(std::string_view line_case, const pipeline::PathTimes& times) {
  times_.insert_or_assign(std::string{line_case}, times);
  changed_ = true;
}

hal::Result<> ReconstructionCache::save() {
  const std::string wisdom = pipeline::export_fft_wisdom();
  if (!changed_ && wisdom == saved_wisdom_)
    return {};
  if (file_.empty())
    return hal::fail(hal::ErrorCode::absent,
                     "no cache folder: none of CACHE_DIRECTORY, XDG_CACHE_HOME and HOME is an "
                     "absolute path; set one of them");
  std::error_code error;
  fs::create_directories(file_.parent_path(), error); // AtomicFile says what is wrong with it
  json root = {
      {"written_by", fingerprint_}, {"fftw_wisdom", wisdom}, {"ns_per_line", json::object()}};
  for (const auto& [line_case, times] : times_)
    root["ns_per_line"][line_case] = {{"fused", times.fused_ns}, {"fftw", times.fftw_ns}};
  // A processor's name is whatever its maker wrote: no byte of it may stop us.
  const std::string text = root.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
  HAL_TRY(auto out, pipeline::AtomicFile::create(file_));
  auto written =
      out.write_at(0, std::as_bytes(std::span{text})).and_then([&] { return out.commit(); });
  if (written) {
    changed_ = false;
    saved_wisdom_ = wisdom;
  }
  return written;
}

} // namespace octascope::firmware_host
