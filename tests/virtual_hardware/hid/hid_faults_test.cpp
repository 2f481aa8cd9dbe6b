// What can be wrong with a control: told in words, and nobody else's keyboard is touched.
#include <array>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <grp.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"
#include "tests/virtual_hardware/hid/hid_bench.h"

namespace octascope::tests {
namespace {

using hal::ErrorCode;
using hal::linux_backend::HidControls;
using testing::AllOf;
using testing::HasSubstr;
using namespace std::chrono_literals;

class HidFaults : public HidTest {
protected:
  static void expect_fault(const auto& result, ErrorCode fault, const auto& message) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, fault) << result.error().message;
    EXPECT_THAT(result.error().message, message);
  }
};

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
  expect_fault(controls_.open(), ErrorCode::absent, HasSubstr("no HID device"));
  const auto keyboard = plug_in(strange_keyboard());
  ASSERT_TRUE(keyboard);
  expect_fault(controls_.open(), ErrorCode::absent,
               AllOf(HasSubstr("1234:5678 Somebody's keyboard"), HasSubstr("--learn")));
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
  expect_fault(controls_.open(), ErrorCode::busy,
               AllOf(HasSubstr("PCsensor"), HasSubstr(pedal->event_node()), HasSubstr("grabbed")));
  other.close();
  EXPECT_TRUE(controls_.open());
}

// In a child, because it cannot become root again.
TEST_F(HidFaults, without_permission_the_message_names_the_udev_rule) {
  const auto pedal = plug_in(vec_pedal());
  ASSERT_TRUE(pedal);
  while (hal::linux_backend::udev_is_at_work()) // it is not denied before
    std::this_thread::sleep_for(10ms);
  ASSERT_EQ(::chmod(pedal->hidraw_node().c_str(), 0600), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    if (::setgroups(0, nullptr) != 0 || ::setuid(65534) != 0)
      ::_exit(2);
    HidControls controls{clock_};
    const auto opened = controls.open();
    const bool told = !opened && opened.error().code == ErrorCode::denied &&
                      opened.error().message.find("70-octascope.rules") != std::string::npos &&
                      opened.error().message.find("VEC Infinity") != std::string::npos;
    if (!told)
      std::fprintf(stderr, "%s\n", opened ? "it opened" : opened.error().message.c_str());
    ::_exit(told ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
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
