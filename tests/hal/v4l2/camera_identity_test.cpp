#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "hal/linux/v4l2/camera_identity.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::hal::linux_backend {
namespace {

namespace fs = std::filesystem;

// A device's folder as the kernel lays it out: a camera's interface in its USB device in a hub.
class UsbCamera : public testing::Test {
protected:
  UsbCamera() {
    fs::create_directories(interface);
    write(hub / "idVendor", "1d6b");
    write(hub / "serial", "0000:00:14.0");
    write(device / "idVendor", "1bcf");
    fs::create_directories(root.path() / "char");
    fs::create_directory_symlink(interface, root.path() / "char/81:0");
  }
  static void write(const fs::path& file, std::string_view text) {
    std::ofstream{file} << text << '\n';
  }

  tests::ScratchFolder root;
  const fs::path hub = root.path() / "usb1";
  const fs::path device = hub / "1-2";
  const fs::path interface = device / "1-2:1.0";
};

TEST_F(UsbCamera, has_the_serial_number_of_its_own_device) {
  write(device / "serial", "  5A3B-77 ");
  EXPECT_EQ(usb_serial_number(root.path() / "char/81:0"), "5A3B-77");
}

TEST_F(UsbCamera, without_a_serial_number_does_not_take_its_hubs) {
  EXPECT_EQ(usb_serial_number(root.path() / "char/81:0"), "");
}

TEST_F(UsbCamera, on_another_bus_has_none) {
  const fs::path card = root.path() / "pci0000:00/0000:03:00.0";
  fs::create_directories(card);
  write(card / "serial", "not a camera's");
  EXPECT_EQ(usb_serial_number(card), "");
  EXPECT_EQ(usb_serial_number(root.path() / "missing"), "");
}

TEST(CameraIdentity, tells_two_of_a_kind_apart_by_their_serial_numbers) {
  EXPECT_EQ(camera_identity("Octoplus 4K", "0123"), "Octoplus 4K, serial 0123");
  EXPECT_NE(camera_identity("Octoplus 4K", "0123"), camera_identity("Octoplus 4K", "0124"));
  EXPECT_EQ(camera_identity("Octoplus 4K", ""), "Octoplus 4K, no serial number");
}

TEST(CameraIdentity, can_be_copied_into_a_calibration) {
  EXPECT_EQ(camera_identity(" say \"cheese\"\n\\ ", "\x01\x7f"), "say ?cheese???, serial ??");
}

TEST(CameraIdentity, looks_where_the_kernel_lists_device_nodes) {
  const FileDescriptor null{::open("/dev/null", O_RDONLY | O_CLOEXEC)};
  EXPECT_EQ(sysfs_folder(null), "/sys/dev/char/1:3/device");
}

} // namespace
} // namespace octascope::hal::linux_backend
