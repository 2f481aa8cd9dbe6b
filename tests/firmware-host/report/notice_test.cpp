#include <array>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "firmware-host/report/notice.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using hal::DeviceState;

constexpr hal::TimePoint now{100s};

// By its keys in reports.
pipeline::FaultRecord fault(std::string_view device, std::string_view kind, hal::Duration ago) {
  for (std::size_t i = 0; i < pipeline::fault_count; ++i) {
    const auto facts = facts_of(static_cast<pipeline::Fault>(i));
    if (facts.device_key() == device && facts.key == kind)
      return {facts.fault, "", 1, now - ago, now - ago};
  }
  throw std::logic_error{fmt::format("there is no fault {} {}", device, kind)};
}

class Notice : public testing::Test {
protected:
  std::string_view of(std::vector<pipeline::FaultRecord> faults) const {
    return compose_notice(faults, devices, now);
  }

  std::array<ui::DeviceStatus, 4> devices{
      {{pipeline::Device::line_camera, "sim", DeviceState::streaming},
       {pipeline::Device::galvo_trigger, "sim", DeviceState::ready},
       {pipeline::Device::control_input, "sim", DeviceState::ready},
       {pipeline::Device::scope_camera, "sim", DeviceState::streaming}}};
};

TEST_F(Notice, is_empty_when_nothing_is_wrong) {
  EXPECT_EQ(of({}), "");
}

TEST_F(Notice, is_empty_while_devices_are_opened_for_the_first_time) {
  devices[0].state = DeviceState::absent;
  EXPECT_EQ(of({}), "");
}

TEST_F(Notice, names_a_device_for_as_long_as_it_is_away) {
  const auto lost = fault("line_camera", "disconnected", 1h);
  EXPECT_EQ(of({lost}), "") << "back";
  for (const DeviceState state : {DeviceState::absent, DeviceState::failed}) {
    devices[0].state = state;
    EXPECT_EQ(of({lost}), "Line camera disconnected: reconnecting");
  }
}

TEST_F(Notice, names_any_other_fault_until_two_seconds_after_it) {
  EXPECT_NE(of({fault("line_camera", "dropped_frames", 0s)}), "");
  EXPECT_NE(of({fault("line_camera", "dropped_frames", 2s)}), "");
  EXPECT_EQ(of({fault("line_camera", "dropped_frames", 2001ms)}), "");
}

TEST_F(Notice, tells_of_a_restart_after_a_crash_for_a_minute) {
  EXPECT_NE(of({fault("host", "restarted_after_crash", 60s)}), "");
  EXPECT_EQ(of({fault("host", "restarted_after_crash", 61s)}), "");
  const auto drops = fault("line_camera", "dropped_frames", 0s);
  EXPECT_EQ(of({fault("host", "restarted_after_crash", 0s), drops}), of({drops}))
      << "and not in the place of what goes wrong now";
}

TEST_F(Notice, names_threads_that_hang) {
  for (const char* device : {"line_camera", "pipeline", "control_input", "scope_camera"})
    EXPECT_NE(of({fault(device, "stuck_thread", 0s)}), "") << device;
}

TEST_F(Notice, names_what_befalls_the_machine) {
  for (const char* kind : {"throttled", "low_memory", "disk_full"})
    EXPECT_NE(of({fault("host", kind, 0s)}), "") << kind;
}

TEST_F(Notice, of_several_names_the_gravest) {
  const auto light = fault("line_camera", "saturation", 0s);
  const auto drops = fault("line_camera", "dropped_frames", 1s);
  const auto pedal = fault("control_input", "disconnected", 1h);
  EXPECT_EQ(of({light, drops, pedal}), of({drops}));
  EXPECT_EQ(of({drops, light}), of({drops})) << "in any order";
  devices[2].state = DeviceState::absent;
  EXPECT_EQ(of({light, drops, pedal}), "Pedal disconnected: reconnecting");
}

TEST_F(Notice, leaves_to_the_report_what_a_surgeon_cannot_use) {
  EXPECT_EQ(of({fault("host", "no_realtime", 0s), fault("line_camera", "stuck_sequence", 0s),
                fault("control_input", "bounce", 0s)}),
            "");
}

TEST_F(Notice, a_picture_that_could_not_be_kept_is_told) {
  EXPECT_NE(of({fault("host", "picture_not_kept", 0s)}), "");
}

TEST_F(Notice, a_recording_that_ended_by_itself_is_told) {
  for (const char* kind : {"disk_full", "not_kept", "not_finished", "not_begun"})
    EXPECT_NE(of({fault("recording", kind, 0s)}), "") << kind;
}

TEST_F(Notice, has_words_for_every_fault_that_costs_volumes_or_b_scans) {
  for (const auto& [device, kind] : {std::pair{"pipeline", "overrun"},
                                     {"pipeline", "late_tick"},
                                     {"galvo_trigger", "missed_pulse"},
                                     {"line_camera", "overflow"},
                                     {"line_camera", "dropped_frames"},
                                     {"line_camera", "corrupted_frame"},
                                     {"line_camera", "wrong_size"},
                                     {"line_camera", "late_frame"},
                                     {"line_camera", "unplaced_frame"},
                                     {"line_camera", "doubled_frame"}})
    EXPECT_NE(of({fault(device, kind, 0s)}), "") << device << " " << kind;
}

} // namespace
} // namespace octascope::firmware_host
