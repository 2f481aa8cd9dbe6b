// Keyboards at the console: those that are listed are read and typed on nowhere else; the others
// are left alone.
#include <array>
#include <functional>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/input.h>
#include <poll.h>

#include "hal/linux/hid/keyboards/console_keyboards.h"
#include "hal/linux/system/system_error.h"
#include "tests/virtual_hardware/hid/hid_bench.h"
#include "tests/virtual_hardware/support/syscall_faults.h"
#include "tests/virtual_hardware/support/virtual_keyboard.h"

namespace octascope::tests {
namespace {

using hal::DisplayEvent;
using hal::DisplayEventKind;
using hal::linux_backend::ConsoleKeyboards;
using testing::ElementsAre;
using testing::IsEmpty;
using namespace std::chrono_literals;

constexpr std::uint16_t vendor = 0x046d, product = 0xc31c, other_product = 0xc31d;

class ConsoleKeyboardsTest : public HidTest {
protected:
  void TearDown() override { await_udev(); }

  static std::unique_ptr<VirtualKeyboard> plug_in_keyboard(std::uint16_t its_product = product) {
    auto made = VirtualKeyboard::plug_in(vendor, its_product);
    EXPECT_TRUE(made) << made.error().message;
    await_udev();
    return made ? std::move(*made) : nullptr;
  }

  // What comes until nothing has come for a while: "+o" pressed, "-o" released.
  std::vector<std::string> keys(ConsoleKeyboards& keyboards) {
    std::vector<std::string> told;
    std::array<DisplayEvent, 8> events;
    for (int quiet = 0; quiet < 20; ++quiet) {
      for (std::size_t i = 0, count = keyboards.poll_events(events); i < count; ++i, quiet = 0)
        if (!events[i].repeated)
          told.push_back((events[i].kind == DisplayEventKind::key_pressed ? "+" : "-") +
                         std::string(1, static_cast<char>(events[i].key)));
      std::this_thread::sleep_for(10ms);
    }
    return told;
  }

  // Polls as the render loop does, until it is so.
  static bool becomes(ConsoleKeyboards& keyboards, const std::function<bool()>& so) {
    std::array<DisplayEvent, 8> events;
    for (int tries = 0; tries < 1000; ++tries) {
      keyboards.poll_events(events);
      if (so())
        return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  static void type(VirtualKeyboard& keyboard, std::uint16_t key) {
    EXPECT_TRUE(keyboard.set(key, true));
    EXPECT_TRUE(keyboard.set(key, false));
  }

  static bool is_heard_elsewhere(VirtualKeyboard& keyboard) {
    const auto listener =
        hal::linux_backend::open_device(keyboard.event_node(), O_RDONLY | O_NONBLOCK);
    EXPECT_TRUE(listener);
    type(keyboard, KEY_A);
    pollfd waiting{listener->get(), POLLIN, 0};
    return ::poll(&waiting, 1, 100) > 0;
  }

  ConsoleKeyboards keyboards_{clock_, {"046d:c31c"}};
};

TEST_F(ConsoleKeyboardsTest, a_listed_one_is_read_and_types_nowhere_else) {
  const auto keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  keyboards_.attend(true);
  EXPECT_THAT(keyboards_.serving(), ElementsAre(keyboard->event_node()));
  type(*keyboard, KEY_O);
  type(*keyboard, KEY_SPACE);
  EXPECT_THAT(keys(keyboards_), ElementsAre("+o", "-o", "+ ", "- "));
  EXPECT_FALSE(is_heard_elsewhere(*keyboard));
  EXPECT_THAT(keyboards_.complaints(), IsEmpty());
}

TEST_F(ConsoleKeyboardsTest, one_that_is_not_listed_is_left_alone) {
  const auto keyboard = plug_in_keyboard(other_product);
  ASSERT_TRUE(keyboard);
  keyboards_.attend(true);
  EXPECT_THAT(keyboards_.serving(), IsEmpty());
  EXPECT_TRUE(is_heard_elsewhere(*keyboard));
  EXPECT_THAT(keys(keyboards_), IsEmpty());
}

TEST_F(ConsoleKeyboardsTest, pulled_out_its_keys_are_released_and_plugged_in_it_serves_again) {
  auto keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  keyboards_.attend(true);
  EXPECT_TRUE(keyboard->set(KEY_1, true));
  EXPECT_THAT(keys(keyboards_), ElementsAre("+1"));
  keyboard.reset();
  EXPECT_THAT(keys(keyboards_), ElementsAre("-1"));
  EXPECT_THAT(keyboards_.serving(), IsEmpty());
  keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  ASSERT_TRUE(becomes(keyboards_, [&] { return keyboards_.serving().size() == 1; }));
  type(*keyboard, KEY_B);
  EXPECT_THAT(keys(keyboards_), ElementsAre("+b", "-b"));
}

TEST_F(ConsoleKeyboardsTest, pulled_out_and_plugged_in_between_two_polls_it_serves_again) {
  auto keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  keyboards_.attend(true);
  EXPECT_TRUE(keyboard->set(KEY_1, true));
  EXPECT_THAT(keys(keyboards_), ElementsAre("+1"));
  const std::string node = keyboard->event_node();
  keyboard.reset();
  keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  EXPECT_EQ(keyboard->event_node(), node) << "the case that is meant";
  EXPECT_THAT(keys(keyboards_), ElementsAre("-1"));
  type(*keyboard, KEY_B);
  EXPECT_THAT(keys(keyboards_), ElementsAre("+b", "-b"));
}

TEST_F(ConsoleKeyboardsTest, while_another_console_is_in_front_its_keys_are_that_ones) {
  const auto keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  EXPECT_TRUE(is_heard_elsewhere(*keyboard)) << "not yet ours";
  keyboards_.attend(true);
  EXPECT_TRUE(keyboard->set(KEY_T, true));
  EXPECT_THAT(keys(keyboards_), ElementsAre("+t"));
  keyboards_.attend(false);
  EXPECT_THAT(keys(keyboards_), ElementsAre("-t"));
  EXPECT_TRUE(keyboard->set(KEY_T, false));
  EXPECT_TRUE(is_heard_elsewhere(*keyboard));
  EXPECT_THAT(keys(keyboards_), IsEmpty());
  keyboards_.attend(true);
  EXPECT_THAT(keys(keyboards_), IsEmpty()) << "nothing of what was typed meanwhile";
  type(*keyboard, KEY_T);
  EXPECT_THAT(keys(keyboards_), ElementsAre("+t", "-t"));
}

TEST_F(ConsoleKeyboardsTest, one_that_somebody_has_grabbed_is_told_and_taken_when_it_is_free) {
  const auto keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  auto holder = hal::linux_backend::open_device(keyboard->event_node(), O_RDWR);
  ASSERT_TRUE(holder);
  ASSERT_EQ(::ioctl(holder->get(), EVIOCGRAB, 1), 0);
  keyboards_.attend(true);
  EXPECT_THAT(keyboards_.complaints(),
              ElementsAre(testing::AllOf(testing::HasSubstr("046d:c31c"),
                                         testing::HasSubstr("Keyboard of the bench"),
                                         testing::HasSubstr(keyboard->event_node()))));
  holder->reset();
  EXPECT_TRUE(becomes(keyboards_, [&] { return keyboards_.serving().size() == 1; }));
  EXPECT_THAT(keyboards_.complaints(), IsEmpty());
}

// Whatever fails: keys come, or they come after the next look; nothing stays open.
TEST_F(ConsoleKeyboardsTest, every_system_call_that_fails_ends_well) {
  const auto keyboard = plug_in_keyboard();
  ASSERT_TRUE(keyboard);
  const SyscallFaultReport report = inject_faults(
      every_kind, usual_errors(),
      [&]() -> std::optional<std::string> {
        ConsoleKeyboards keyboards{clock_, {"046d:c31c"}};
        keyboards.attend(true);
        (void)keyboard->set(KEY_O, true); // what is not typed, for it was hit, is not read
        std::array<DisplayEvent, 8> events;
        keyboards.poll_events(events);
        (void)keyboard->set(KEY_O, false);
        keyboards.attend(false);
        for (std::size_t count = 1; count > 0;)
          count = keyboards.poll_events(events);
        return keyboards.serving().empty() ? std::nullopt : std::optional{"not let go"};
      },
      false);
  expect_good(report, 21);
  keyboards_.attend(true);
  type(*keyboard, KEY_O);
  EXPECT_THAT(keys(keyboards_), ElementsAre("+o", "-o"));
}

} // namespace
} // namespace octascope::tests
