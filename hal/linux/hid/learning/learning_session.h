// Learns any device by listening on all its nodes (control_learner.h).
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
  // Opens all of the device's `nodes` that can be opened; input devices are grabbed meanwhile.
  static Result<LearningSession> listen_to(std::vector<HidNode> nodes);

  // Returns one line for each report that changed something; waits at most `timeout` for the first.
  // ErrorCode::disconnected: the device was unplugged.
  Result<std::vector<std::string>> listen(Duration timeout);

  std::optional<ControlModel> learned() const;

private:
  struct File {
    HidNode node;
    ControlLearner learner;
    FileDescriptor input = {}; // for an input device; a raw device has a reader instead
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
