#include "firmware-host/configuration/configuration_check.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/acquisition/repeat_comparison.h"
#include "pipeline/calibration/calibration.h"
#include "sim/devices/control_script.h"
#include "sim/faults/fault_script.h"
#include "sim/spectra/volume_loop.h"

namespace octascope::firmware_host {

namespace {

// What is wrong with the files that a configuration names, in their order.
class Complaints {
public:
  explicit Complaints(const std::filesystem::path& configuration) : configuration_(configuration) {}

  template <class Value> void take(const hal::Result<Value>& read) {
    if (read)
      return;
    const std::string& message = read.error().message;
    texts_.push_back(message.find(".toml") == std::string::npos
                         ? fmt::format("{}: {}", configuration_.string(), message)
                         : message);
  }
  const std::vector<std::string>& texts() const { return texts_; }

private:
  const std::filesystem::path& configuration_;
  std::vector<std::string> texts_;
};

// Samples of a line, as the run will have them.
hal::Result<int> samples_of(const Configuration& configuration, const RunOptions& options) {
  if (options.recording)
    return options.recording->shape.samples;
  pipeline::ScanPlan plan = plan_of(options, configuration);
  HAL_CHECK(plan.validate());
  HAL_TRY(auto loop, sim::suggested_loop(options.phantom.value_or(configuration.phantom)));
  return configuration.plan ? plan.samples : loop.plan.samples;
}

void check_calibrations(const Configuration& configuration, int samples, Complaints& complaints) {
  std::vector<std::filesystem::path> files;
  if (configuration.calibration)
    files.push_back(*configuration.calibration);
  for (const Objective& objective : configuration.objectives) {
    if (objective.calibration && std::ranges::find(files, *objective.calibration) == files.end())
      files.push_back(*objective.calibration);
  }
  for (const auto& file : files)
    complaints.take(pipeline::Calibration::load(file, samples));
}

std::vector<std::string> named_file_complaints(const std::filesystem::path& file,
                                               const Configuration& configuration,
                                               const RunOptions& options) {
  Complaints complaints{file};
  const auto samples = samples_of(configuration, options);
  complaints.take(samples);
  if (samples)
    check_calibrations(configuration, *samples, complaints);
  if (samples && tells_flow(options, configuration))
    complaints.take(pipeline::RepeatComparison::check(plan_of(options, configuration)));
  complaints.take(load_controls(configuration));
  if (configuration.faults)
    complaints.take(sim::FaultScript::load(*configuration.faults));
  if (configuration.controls)
    complaints.take(sim::ControlScript::load(*configuration.controls));
  return complaints.texts();
}

} // namespace

hal::Result<Configuration> load_whole_configuration(const std::filesystem::path& file,
                                                    const RunOptions& options) {
  HAL_TRY(const auto document, pipeline::ConfigDocument::load(file));
  auto configuration = read_configuration(document);
  document.complain_about_missing_files();
  std::vector<std::string> complaints = document.complaints();
  if (configuration && complaints.empty())
    complaints = named_file_complaints(file, *configuration, options);
  if (!complaints.empty())
    return hal::fail(hal::ErrorCode::invalid_argument, "{}", fmt::join(complaints, "\n"));
  return configuration;
}

std::vector<std::filesystem::path> files_of_calibration(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  if (const auto document = pipeline::calibration_document(file)) {
    for (const pipeline::NamedFile& named : document->named_files())
      files.push_back(named.file);
  }
  return files;
}

std::vector<std::filesystem::path> files_of_configuration(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  const auto document = pipeline::ConfigDocument::load(file);
  if (!document)
    return files;
  const auto read = read_configuration(*document); // for the names: good or not
  for (const pipeline::NamedFile& named : document->named_files()) {
    files.push_back(named.file);
    const auto nested = files_of_calibration(named.file);
    files.insert(files.end(), nested.begin(), nested.end());
  }
  return files;
}

std::vector<std::string> configuration_complaints(const std::filesystem::path& file) {
  const auto read = load_whole_configuration(file);
  std::vector<std::string> complaints;
  if (read)
    return complaints;
  std::istringstream lines{read.error().message};
  for (std::string line; std::getline(lines, line);)
    complaints.push_back(line);
  return complaints;
}

} // namespace octascope::firmware_host
