// Runs this very program once more, as its user would, and reads the report that it leaves.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "firmware-host/ledger/shown_quality.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// A folder for a benchmark's files; gone with all that is in it when the benchmark is over.
class BenchFolder {
public:
  static hal::Result<BenchFolder> make();
  BenchFolder(BenchFolder&& other) noexcept : folder_{std::exchange(other.folder_, {})} {}
  BenchFolder& operator=(BenchFolder&&) = delete;
  ~BenchFolder();

  std::filesystem::path file(const char* name) const { return folder_ / name; }

private:
  explicit BenchFolder(std::filesystem::path folder) : folder_{std::move(folder)} {}

  std::filesystem::path folder_;
};

// `octascope ARGUMENTS --report FILE`; waits for its end. Not on a thread that must not block.
hal::Result<nlohmann::json> report_of(std::vector<std::string> arguments,
                                      const std::filesystem::path& report);

// A number in that report; 0 if it is null.
double number_in(const nlohmann::json& report, const char* pointer);

// Its "quality".
QualitySummary quality_in(const nlohmann::json& report);

} // namespace octascope::firmware_host
