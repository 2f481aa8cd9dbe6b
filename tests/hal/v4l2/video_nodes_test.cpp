#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "hal/linux/v4l2/video_nodes.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::hal::linux_backend {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::FailsWith;

LineCameraCandidate camera(const char* node, const char* bus) {
  return {.identity = {node, "card", "driver", bus},
          .formats = "Y12",
          .captures = true,
          .unsuitable = std::nullopt};
}

LineCameraCandidate unsuitable(const char* node, ErrorCode fault, const char* message) {
  LineCameraCandidate candidate = camera(node, "bus");
  candidate.captures = fault != ErrorCode::denied;
  candidate.unsuitable = Error{fault, message};
  return candidate;
}

TEST(VideoNodes, are_listed_by_their_numbers) {
  const tests::ScratchFolder folder;
  for (const char* name : {"video10", "video2", "video0", "video", "video1x", "videodev", "vbi0"})
    std::ofstream{folder / name};
  std::vector<std::string> names;
  for (const std::string& node : video_nodes(folder / ""))
    names.push_back(std::filesystem::path{node}.filename());
  EXPECT_THAT(names, ElementsAre("video0", "video2", "video10"));
  EXPECT_TRUE(video_nodes(folder / "missing").empty());
}

TEST(VideoNodes, the_first_that_suits_is_picked_but_the_one_of_last_time_before) {
  const std::vector candidates{unsuitable("/dev/video0", ErrorCode::unsupported, "a web camera"),
                               camera("/dev/video1", "usb-1"), camera("/dev/video4", "usb-2")};
  EXPECT_EQ(pick_line_camera(candidates, "", {}).value(), "/dev/video1");
  EXPECT_EQ(pick_line_camera(candidates, "usb-2", {}).value(), "/dev/video4");
  EXPECT_EQ(pick_line_camera(candidates, "usb-3", {}).value(), "/dev/video1");
}

TEST(VideoNodes, without_one_it_is_absent_and_each_camera_has_its_reason) {
  EXPECT_THAT(pick_line_camera({}, "", {}),
              FailsWith(ErrorCode::absent, "0 video devices, expected one with 379 lines"));
  EXPECT_THAT(
      pick_line_camera({unsuitable("/dev/video0", ErrorCode::unsupported, "a web camera")}, "", {}),
      FailsWith(ErrorCode::absent, "a web camera"));
}

TEST(VideoNodes, missing_permission_is_said_once) {
  EXPECT_THAT(pick_line_camera({unsuitable("/dev/video0", ErrorCode::denied, "join video"),
                                unsuitable("/dev/video1", ErrorCode::denied, "join video")},
                               "", {}),
              FailsWith(ErrorCode::denied, "2 of them may not be opened: join video"));
}

TEST(VideoNodes, what_is_no_video_device_is_refused_in_words) {
  MonotonicClock clock;
  V4l2LineCamera nowhere{{.node = "/dev/video-none"}, clock};
  const auto absent = nowhere.open({});
  ASSERT_THAT(absent, FailsWith(ErrorCode::absent));
  EXPECT_EQ(nowhere.state(), DeviceState::absent);
  V4l2LineCamera other{{.node = "/dev/null"}, clock};
  EXPECT_THAT(other.open({}),
              FailsWith(ErrorCode::unsupported, "/dev/null: it is no video device"));
}

} // namespace
} // namespace octascope::hal::linux_backend
