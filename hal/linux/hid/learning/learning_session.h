// Listens to one device with all its files, whatever it is, and learns (control_learner.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/linux/hid/learning/control_learner.h"
#include "hal/linux/hid/raw/raw_device.h"
#include "hal/linux/hid/raw/report_reader.h"
#include "hal/linux/hid/survey/hid_survey.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Threads: one at a time.
class LearningSession {
public:
  // Of the device, all of `nodes` that can be opened; one that types is grabbed meanwhile.
  static Result<LearningSession> listen_to(std::vector<HidNode> nodes);

  // What has been sent, a line for each report that changes something; waits at most `timeout` for
  // the first. ErrorCode::disconnected: it was pulled out.
  Result<std::vector<std::string>> listen(Duration timeout);

  std::optional<ControlModel> learned() const;

private:
  struct File {
    HidNode node;
    ControlLearner learner;
    FileDescriptor input = {}; // of an input device; else it is a raw one, with its reader
    std::unique_ptr<RawDevice> device = {};
    std::unique_ptr<ReportReader> reader = {};
  };
  static Result<File> open(const HidNode& node);
  static Result<File> open_input(const HidNode& node);
  static Result<> read_input(File& file, std::vector<std::string>& lines);
  static Result<> read_reports(File& file, std::vector<std::string>& lines);

  std::vector<File> files_;
};

} // namespace octascope::hal::linux_backend
