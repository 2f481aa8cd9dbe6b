#include "firmware-host/configuration/configuration_check.h"

#include <fmt/format.h>

#include "pipeline/calibration/calibration.h"
#include "sim/devices/control_script.h"
#include "sim/faults/fault_script.h"
#include "sim/spectra/volume_loop.h"

namespace octascope::firmware_host {

namespace {

template <class Value> hal::Result<> verdict_of(const hal::Result<Value>& read) {
  return read ? hal::Result<>{} : tl::make_unexpected(read.error());
}

// Samples of a line, as the run will have them.
hal::Result<int> samples_of(const Configuration& configuration, const RunOptions& options) {
  if (options.recording)
    return options.recording->shape.samples;
  pipeline::ScanPlan plan = plan_of(options, configuration);
  HAL_CHECK(plan.validate());
  HAL_TRY(auto loop, sim::suggested_loop(options.phantom.value_or(configuration.phantom)));
  return configuration.plan ? plan.samples : loop.plan.samples;
}

hal::Result<> check_calibrations(const Configuration& configuration, int samples) {
  if (configuration.calibration)
    HAL_CHECK(pipeline::Calibration::load(*configuration.calibration, samples));
  for (const Objective& objective : configuration.objectives) {
    if (!objective.calibration)
      continue;
    HAL_CHECK(pipeline::Calibration::load(*objective.calibration, samples));
  }
  return {};
}

} // namespace

hal::Result<> check_named_files(const Configuration& configuration, const RunOptions& options) {
  HAL_TRY(const auto samples, samples_of(configuration, options));
  HAL_CHECK(check_calibrations(configuration, samples));
  HAL_CHECK(verdict_of(load_controls(configuration)));
  if (configuration.faults)
    HAL_CHECK(verdict_of(sim::FaultScript::load(*configuration.faults)));
  return configuration.controls ? verdict_of(sim::ControlScript::load(*configuration.controls))
                                : hal::Result<>{};
}

hal::Result<Configuration> load_whole_configuration(const std::filesystem::path& file,
                                                    const RunOptions& options) {
  auto configuration = load_configuration(file);
  if (!configuration)
    return configuration;
  if (const auto checked = check_named_files(*configuration, options); !checked)
    return hal::fail(checked.error().code,
                     checked.error().message.find(".toml") == std::string::npos
                         ? fmt::format("{}: {}", file.string(), checked.error().message)
                         : checked.error().message);
  return configuration;
}

std::vector<std::string> configuration_complaints(const std::filesystem::path& file) {
  const auto document = pipeline::ConfigDocument::load(file);
  if (!document)
    return {document.error().message};
  const auto read = read_configuration(*document);
  std::vector<std::string> complaints = document->complaints();
  if (read)
    if (const auto checked = check_named_files(*read); !checked)
      complaints.push_back(checked.error().message);
  return complaints;
}

} // namespace octascope::firmware_host
