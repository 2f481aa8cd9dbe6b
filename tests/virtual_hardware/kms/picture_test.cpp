// What is drawn is what the screen shows, pixel for pixel: read back from the frame buffer that the
// kernel's virtual display scans.
#include <algorithm>
#include <optional>

#include <GLES3/gl3.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/kms/vkms_card.h"
#include "tests/virtual_hardware/support/scanout_reader.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;

struct Rgb {
  int red = 0;
  int green = 0;
  int blue = 0;
  bool operator==(const Rgb&) const = default;
};

void PrintTo(const Rgb& c, std::ostream* out) {
  *out << c.red << ',' << c.green << ',' << c.blue;
}

constexpr int cell = 32;

// A colour for each cell of the picture and each frame: nothing repeats, nothing is symmetric.
Rgb colour_of(int x, int y, int frame) {
  const int column = x / cell;
  const int row = y / cell;
  return {(column * 26 + frame * 50) % 256, (row * 37 + 7) % 256, (column * row * 5 + 90) % 256};
}

// The top row of a picture is GL's last.
void draw(int width, int height, int frame) {
  glEnable(GL_SCISSOR_TEST);
  for (int y = 0; y < height; y += cell)
    for (int x = 0; x < width; x += cell) {
      const Rgb c = colour_of(x, y, frame);
      glScissor(x, height - y - cell, cell, cell);
      glClearColor(static_cast<float>(c.red) / 255.0F, static_cast<float>(c.green) / 255.0F,
                   static_cast<float>(c.blue) / 255.0F, 1);
      glClear(GL_COLOR_BUFFER_BIT);
    }
  glDisable(GL_SCISSOR_TEST);
}

Rgb at(const ScanoutPicture& picture, int x, int y) {
  const std::uint8_t* const p = picture.pixel(x, y);
  return {p[0], p[1], p[2]};
}

class KmsPicture : public testing::TestWithParam<bool> {
protected:
  void SetUp() override {
    if (!find_vkms())
      GTEST_SKIP() << no_vkms;
    config_.atomic = GetParam();
  }

  void open(const std::string& mode) {
    config_.mode = mode;
    display_.emplace(clock_, config_);
    const auto opened = display_->open({});
    ASSERT_TRUE(opened) << opened.error().message;
  }

  void show(int frame) {
    draw(display_->width(), display_->height(), frame);
    const auto flip = display_->present();
    ASSERT_TRUE(flip) << flip.error().message;
  }

  // Every pixel of `part` as drawn, every other one black.
  static void expect_shown(const hal::linux_backend::kms::Rectangle& part, int frame) {
    const auto picture = read_scanout();
    ASSERT_TRUE(picture) << picture.error().message;
    int wrong = 0;
    for (int y = 0; y < picture->height; ++y)
      for (int x = 0; x < picture->width; ++x) {
        const bool inside =
            x >= part.x && x < part.x + part.width && y >= part.y && y < part.y + part.height;
        const Rgb expected = inside ? colour_of(x - part.x, y - part.y, frame) : Rgb{};
        if (at(*picture, x, y) != expected && ++wrong <= 3) {
          EXPECT_EQ(at(*picture, x, y), expected) << "at " << x << ", " << y;
        }
      }
    EXPECT_EQ(wrong, 0) << "of " << picture->width << 'x' << picture->height;
  }

  hal::linux_backend::MonotonicClock clock_;
  KmsConfig config_;
  std::optional<KmsDisplay> display_;
};

INSTANTIATE_TEST_SUITE_P(Calls, KmsPicture, testing::Bool(), [](const auto& with) {
  return std::string{with.param ? "atomic" : "legacy"};
});

TEST_P(KmsPicture, is_black_before_the_first_and_then_the_newest_that_was_drawn) {
  open("");
  EXPECT_EQ(display_->width(), 1024) << "vkms prefers 1024x768";
  EXPECT_EQ(display_->height(), 768);
  const auto first = read_scanout();
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_TRUE(std::all_of(first->rgb.begin(), first->rgb.end(), [](auto v) { return v == 0; }));
  for (int frame = 1; frame <= 4; ++frame) {
    show(frame);
    expect_shown({0, 0, 1024, 768}, frame);
  }
}

// Mesa's software renderer would otherwise map the buffer anew for each picture, and each of its pages then costs
// a fault.
TEST_P(KmsPicture, finds_the_pages_of_the_one_before) {
  open("");
  const auto faults_of = [this](int pictures) {
    rusage before{}, after{};
    ::getrusage(RUSAGE_SELF, &before);
    for (int i = 0; i < pictures; ++i) {
      glClear(GL_COLOR_BUFFER_BIT);
      EXPECT_TRUE(display_->present());
    }
    ::getrusage(RUSAGE_SELF, &after);
    return after.ru_minflt - before.ru_minflt;
  };
  faults_of(4); // the surface has no more buffers
  const long pages = 4L * display_->width() * display_->height() / ::sysconf(_SC_PAGESIZE);
  EXPECT_LT(faults_of(8), pages);
}

TEST_P(KmsPicture, has_the_configured_mode) {
  open("800x600@60");
  ASSERT_NO_FATAL_FAILURE(show(1));
  expect_shown({0, 0, 800, 600}, 1);
  EXPECT_NE(display_->description().find("Virtual-1, 800x600@60"), std::string::npos)
      << display_->description();
}

TEST_P(KmsPicture, lies_within_the_margins) {
  config_.overscan = {10, 5, 20, 0};
  open("640x480");
  const hal::linux_backend::kms::Rectangle part{64, 96, 544, 384};
  EXPECT_EQ(display_->width(), part.width);
  EXPECT_EQ(display_->height(), part.height);
  for (int frame = 1; frame <= 3; ++frame) {
    show(frame);
    expect_shown(part, frame);
  }
}

TEST_P(KmsPicture, leaves_the_output_as_it_was) {
  open("640x480");
  ASSERT_NO_FATAL_FAILURE(show(1));
  display_->close();
  EXPECT_THAT(read_scanout(), FailsWith(hal::ErrorCode::absent));
}

} // namespace
} // namespace octascope::tests
