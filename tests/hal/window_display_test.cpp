#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <SDL.h>

#include "hal/linux/monotonic_clock.h"
#include "hal/linux/sdl_library.h"
#include "hal/linux/window_display.h"
#include "tests/contract/display_contract.h"
#include "tests/support/fails_with.h"
#include "tests/support/pictures/virtual_screen.h"

namespace octascope::tests {
namespace {

// Holds the GL driver in the process: SDL unloads it with each window, and the sanitizers can
// neither name nor set aside what an unloaded library did.
void keep_driver_loaded() {
  eglInitialize(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                nullptr, nullptr);
}

struct WindowMaker {
  WindowMaker() { keep_driver_loaded(); }

  VirtualScreen screen;
  hal::linux_backend::MonotonicClock clock;
  hal::linux_backend::WindowDisplay window{clock};

  hal::Display& display() { return window; }
  std::optional<std::string> unavailable() {
    return screen.running() ? std::nullopt : std::optional{screen.problem()};
  }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Window, DisplayContract, WindowMaker);

class WindowDisplay : public testing::Test {
protected:
  void SetUp() override {
    if (!maker_.screen.running())
      GTEST_SKIP() << maker_.screen.problem();
    if (std::system("command -v xdotool > /dev/null") != 0)
      GTEST_SKIP() << "no xdotool to press keys with";
    hal::DisplayConfig config;
    config.width = 400;
    config.height = 300;
    config.title = "octascope test";
    const auto opened = maker_.window.open(config);
    ASSERT_TRUE(opened) << opened.error().message;
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(maker_.window.present());
  }

  // Runs xdotool on the window and gathers the events of the next half second.
  std::vector<hal::DisplayEvent> after(const std::string& action) {
    const std::string command =
        "xdotool search --sync --name '^octascope test$' windowfocus --sync " + action;
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::vector<hal::DisplayEvent> all;
    for (int i = 0; i < 30; ++i) {
      EXPECT_TRUE(maker_.window.present());
      std::array<hal::DisplayEvent, 8> events;
      const std::size_t count = maker_.window.poll_events(events);
      all.insert(all.end(), events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return all;
  }

  static bool contains(const std::vector<hal::DisplayEvent>& events, hal::DisplayEventKind kind,
                       std::uint16_t key, bool shift) {
    for (const hal::DisplayEvent& event : events)
      if (event.kind == kind && event.key == key && event.shift == shift)
        return true;
    return false;
  }

  WindowMaker maker_;
};

TEST_F(WindowDisplay, is_no_twin) {
  EXPECT_FALSE(maker_.window.simulated());
  EXPECT_EQ(maker_.window.backend(), "window");
}

TEST_F(WindowDisplay, reports_keys) {
  using enum hal::DisplayEventKind;
  const auto events = after("key Left o shift+o bracketleft F9");
  EXPECT_TRUE(contains(events, key_pressed, static_cast<std::uint16_t>(hal::Key::left), false));
  EXPECT_TRUE(contains(events, key_released, static_cast<std::uint16_t>(hal::Key::left), false));
  EXPECT_TRUE(contains(events, key_pressed, 'o', false));
  EXPECT_TRUE(contains(events, key_pressed, 'o', true));
  EXPECT_TRUE(contains(events, key_pressed, '[', false));
  for (const hal::DisplayEvent& event : events)
    EXPECT_TRUE(event.kind == resized || event.key != 0) << "F9 means nothing to us";
}

TEST_F(WindowDisplay, follows_its_size) {
  const auto events = after("windowsize 512 320");
  EXPECT_TRUE(contains(events, hal::DisplayEventKind::resized, 0, false));
  EXPECT_EQ(maker_.window.width(), 512);
  EXPECT_EQ(maker_.window.height(), 320);
}

// What SDL makes of the close button; pressing a real one takes a window manager.
TEST_F(WindowDisplay, reports_the_close_button) {
  SDL_Event close{};
  close.type = SDL_QUIT;
  ASSERT_EQ(SDL_PushEvent(&close), 1);
  std::array<hal::DisplayEvent, 8> events;
  const std::size_t count = maker_.window.poll_events(events);
  ASSERT_GE(count, 1U);
  EXPECT_EQ(events[count - 1].kind, hal::DisplayEventKind::close_requested);
  EXPECT_EQ(maker_.window.state(), hal::DeviceState::ready) << "closing is the host's to decide";
}

TEST(SdlLibrary, that_is_missing_or_another_one_says_what_to_install) {
  for (const char* const wrong : {"libSDL-of-nobody.so.0", "libc.so.6"})
    EXPECT_THAT(hal::linux_backend::SdlLibrary::load(wrong),
                FailsWith(hal::ErrorCode::unsupported, "apt install libsdl2-2.0-0", wrong));
}

TEST(WindowDisplayWithoutScreen, says_what_is_missing) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  setenv("SDL_VIDEODRIVER", "x11", 1);
  hal::linux_backend::MonotonicClock clock;
  hal::linux_backend::WindowDisplay window{clock};
  EXPECT_THAT(window.open({}), FailsWith(hal::ErrorCode::absent, "DISPLAY"));
  EXPECT_EQ(window.state(), hal::DeviceState::absent);
}

} // namespace
} // namespace octascope::tests
