#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/linux/libcamera/camera_choice.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::tests {
namespace {

namespace backend = hal::linux_backend;
using backend::choose_camera;
using testing::Test;

const std::vector<backend::LibcameraFound> three{
    {"usb-1", "Line grabber", true}, {"usb-2", "Webcam", false}, {"csi-0", "imx477", false}};

TEST(CameraChoice, takes_the_first_that_is_not_the_line_camera) {
  EXPECT_EQ(choose_camera(three, ""), 1U);
  EXPECT_THAT(choose_camera({three[0]}, ""), FailsWith(hal::ErrorCode::absent, "Line grabber"));
}

TEST(CameraChoice, takes_what_is_asked_for_by_id_model_or_part) {
  EXPECT_EQ(choose_camera(three, "csi-0"), 2U);
  EXPECT_EQ(choose_camera(three, "imx477"), 2U);
  EXPECT_EQ(choose_camera(three, "csi"), 2U);
  EXPECT_EQ(choose_camera(three, "Line"), 0U) << "who names it means it";
  EXPECT_EQ(choose_camera({{"usb-10", "A", false}, {"usb-1", "B", false}}, "usb-1"), 1U)
      << "the whole name before a part";
  const auto missing = choose_camera(three, "ov5647");
  ASSERT_THAT(missing, FailsSaying("ov5647"));
  EXPECT_NE(missing.error().message.find("imx477"), std::string::npos) << "what there is";
}

class Absence : public Test {
protected:
  void make(const std::string& file) {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    folder_.write(file, "");
  }
  hal::Error explained() const { return backend::explain_absence(folder_.path()); }
  bool says(const char* words) const {
    return explained().message.find(words) != std::string::npos;
  }
  ScratchFolder folder_;
};

TEST_F(Absence, without_udevd_says_how_to_start_it) {
  make("dev/media0");
  EXPECT_TRUE(says("no udev daemon runs")) << explained().message;
  EXPECT_TRUE(says("systemctl start systemd-udevd"));
  EXPECT_EQ(explained().code, hal::ErrorCode::absent);
}

TEST_F(Absence, without_the_modules_that_steer_cameras_says_which_package) {
  make("run/udev/control");
  make("dev/media0");
  EXPECT_TRUE(says("apt-get install libcamera-ipa")) << explained().message;
}

TEST_F(Absence, with_a_node_that_may_not_be_opened_says_which_group) {
  if (::geteuid() == 0)
    GTEST_SKIP() << "root may open everything";
  make("run/udev/control");
  make("dev/media0");
  ::chmod((folder_.path() / "dev/media0").c_str(), 0);
  EXPECT_EQ(explained().code, hal::ErrorCode::denied);
  EXPECT_TRUE(says("/dev/media0"));
  EXPECT_TRUE(says("usermod -aG video"));
  make("run/udev/queue");
  EXPECT_EQ(explained().code, hal::ErrorCode::absent) << "udev may be about to allow it";
}

TEST_F(Absence, with_nothing_plugged_in_says_so) {
  make("run/udev/control");
  make("usr/lib/x86_64-linux-gnu/libcamera/ipa_vimc.so");
  EXPECT_TRUE(says("no camera is plugged in")) << explained().message;
}

TEST_F(Absence, with_devices_that_are_no_cameras_says_how_many) {
  make("run/udev/control");
  make("usr/lib/x86_64-linux-gnu/libcamera/ipa_vimc.so");
  make("dev/media0");
  make("dev/media1");
  EXPECT_TRUE(says("2 media devices are plugged in")) << explained().message;
}

} // namespace
} // namespace octascope::tests
