// What can be wrong with a control: told in words, and nobody else's keyboard is touched.
#include <array>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/hid/hid_bench.h"
#include "tests/virtual_hardware/support/without_permission.h"

namespace octascope::tests {
namespace {

using hal::ErrorCode;
using hal::linux_backend::HidControls;
using testing::HasSubstr;
using namespace std::chrono_literals;

class HidFaults : public HidTest {};

VirtualPedalKind strange_keyboard() {
  VirtualPedalKind kind = pcsensor_pedal("Somebody's keyboard");
  kind.vendor = 0x1234;
  kind.product = 0x5678;
  return kind;
}

constexpr std::array<std::uint8_t, 9> key_down{1, 0, 0, 0x05, 0, 0, 0, 0, 0};
constexpr std::array<std::uint8_t, 9> key_up{1, 0, 0, 0, 0, 0, 0, 0, 0};

// Does somebody who listens to the device hear a key that is typed on it?
bool is_heard(VirtualPedal& pedal) {
  const auto listener = hal::linux_backend::open_device(pedal.event_node(), O_RDONLY | O_NONBLOCK);
  EXPECT_TRUE(listener);
  EXPECT_TRUE(pedal.send(key_down));
  EXPECT_TRUE(pedal.send(key_up));
  pollfd waiting{listener->get(), POLLIN, 0};
  return ::poll(&waiting, 1, 100) > 0;
}

TEST_F(HidFaults, nothing_that_is_known_is_told_with_what_is_there) {
  EXPECT_THAT(controls_.open(), FailsWith(ErrorCode::absent, "no HID device"));
  const auto keyboard = plug_in(strange_keyboard());
  ASSERT_TRUE(keyboard);
  EXPECT_THAT(controls_.open(),
              FailsWith(ErrorCode::absent, "1234:5678 Somebody's keyboard", "--learn"));
}

TEST_F(HidFaults, a_strange_keyboard_steers_nothing_and_is_left_alone) {
  const auto keyboard = plug_in(strange_keyboard());
  const auto pedal = plug_in(vec_pedal());
  ASSERT_TRUE(keyboard && pedal);
  ASSERT_TRUE(controls_.open());
  EXPECT_EQ(controls_.serving().size(), 1U);
  EXPECT_TRUE(is_heard(*keyboard));
  EXPECT_EQ(read_all(), Moves{});
}

TEST_F(HidFaults, a_pedal_that_types_is_grabbed_while_it_is_open) {
  const auto pedal = plug_in(pcsensor_pedal());
  ASSERT_TRUE(pedal);
  EXPECT_TRUE(is_heard(*pedal));
  ASSERT_TRUE(controls_.open());
  EXPECT_FALSE(is_heard(*pedal)) << "it would type into the console";
  controls_.close();
  EXPECT_TRUE(is_heard(*pedal));
}

TEST_F(HidFaults, a_pedal_that_somebody_has_grabbed_is_busy_until_it_is_let_go) {
  const auto pedal = plug_in(pcsensor_pedal());
  ASSERT_TRUE(pedal);
  HidControls other{clock_};
  ASSERT_TRUE(other.open());
  EXPECT_THAT(controls_.open(),
              FailsWith(ErrorCode::busy, "PCsensor", pedal->event_node(), "grabbed"));
  other.close();
  EXPECT_TRUE(controls_.open());
}

TEST_F(HidFaults, without_permission_the_message_names_the_udev_rule) {
  const auto pedal = plug_in(vec_pedal());
  ASSERT_TRUE(pedal);
  while (hal::linux_backend::udev_is_at_work()) // it is not denied before
    std::this_thread::sleep_for(10ms);
  ASSERT_EQ(::chmod(pedal->hidraw_node().c_str(), 0600), 0);
  check_as_nobody([&] {
    EXPECT_THAT(HidControls{clock_}.open(),
                FailsWith(ErrorCode::denied, "70-octascope.rules", "VEC Infinity"));
  });
}

TEST_F(HidFaults, one_that_cannot_be_opened_does_not_keep_the_others_from_serving) {
  const auto pedal = plug_in(vec_pedal());
  const auto typing = plug_in(pcsensor_pedal());
  ASSERT_TRUE(pedal && typing);
  const auto holder = hal::linux_backend::open_device(typing->event_node(), O_RDWR);
  ASSERT_TRUE(holder);
  ASSERT_EQ(::ioctl(holder->get(), EVIOCGRAB, 1), 0);
  ASSERT_TRUE(controls_.open());
  EXPECT_EQ(controls_.serving().size(), 1U);
  ASSERT_EQ(controls_.complaints().size(), 1U);
  EXPECT_THAT(controls_.complaints()[0], HasSubstr("PCsensor"));
}

TEST_F(HidFaults, reports_of_another_size_are_passed_over) {
  VirtualPedalKind kind = shuttle_xpress();
  kind.descriptor = space_navigator().descriptor; // sends 7 bytes where 5 are right
  const auto device = plug_in(kind);
  ASSERT_TRUE(device);
  ASSERT_TRUE(controls_.open());
  EXPECT_TRUE(device->send({1, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}));
  EXPECT_EQ(read_all(), Moves{});
  EXPECT_EQ(controls_.state(), hal::DeviceState::ready);
}

} // namespace
} // namespace octascope::tests
