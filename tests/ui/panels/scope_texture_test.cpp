#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/ui/support/gl_test.h"
#include "ui/panels/scope_texture.h"

namespace octascope::tests {
namespace {

using hal::PixelFormat;

using Colour = std::array<double, 3>; // 0…255

// ITU-R BT.601-7 from its luma coefficients, in doubles: independent of the shader's constants.
Colour bt601(double luma, double cb, double cr) {
  constexpr double red = 0.299;
  constexpr double blue = 0.114;
  constexpr double green = 1 - red - blue;
  const double y = (luma - 16) / 219;
  const double r = y + 2 * (1 - red) * (cr - 128) / 224;
  const double b = y + 2 * (1 - blue) * (cb - 128) / 224;
  const double g = (y - red * r - blue * b) / green;
  const auto byte = [](double value) { return 255 * std::clamp(value, 0.0, 1.0); };
  return {byte(r), byte(g), byte(b)};
}

struct Picture {
  PixelFormat format;
  int width;
  int height;
  int stride;
  std::vector<std::byte> bytes;

  hal::ScopeFrame frame() const { return {0, width, height, stride, format, bytes, 0, {}}; }
  double at(int row, int byte) const {
    return std::to_integer<int>(bytes[static_cast<std::size_t>(row * stride + byte)]);
  }
  Colour expected(int x, int y) const {
    switch (format) {
    case PixelFormat::rgb8: return {at(y, 3 * x), at(y, 3 * x + 1), at(y, 3 * x + 2)};
    case PixelFormat::rgba8: return {at(y, 4 * x), at(y, 4 * x + 1), at(y, 4 * x + 2)};
    case PixelFormat::yuyv: return bt601(at(y, 2 * x), at(y, x / 2 * 4 + 1), at(y, x / 2 * 4 + 3));
    case PixelFormat::nv12:
      return bt601(at(y, x), at(height + y / 2, x / 2 * 2), at(height + y / 2, x / 2 * 2 + 1));
    }
    return {};
  }
};

int row_bytes(PixelFormat format, int width) {
  switch (format) {
  case PixelFormat::rgb8: return 3 * width;
  case PixelFormat::rgba8: return 4 * width;
  case PixelFormat::yuyv: return 4 * ((width + 1) / 2);
  case PixelFormat::nv12: return 2 * ((width + 1) / 2);
  }
  return 0;
}

int rows(PixelFormat format, int height) {
  return format == PixelFormat::nv12 ? height + (height + 1) / 2 : height;
}

Picture random_picture(PixelFormat format, int width, int height, int padding,
                       std::mt19937& random) {
  Picture picture{format, width, height, row_bytes(format, width) + padding, {}};
  picture.bytes.resize(static_cast<std::size_t>(picture.stride * (rows(format, height) - 1) +
                                                row_bytes(format, width)));
  for (std::byte& byte : picture.bytes)
    byte = static_cast<std::byte>(random());
  return picture;
}

class ScopeTextureTest : public GlTest {
protected:
  void SetUp() override {
    GlTest::SetUp();
    if (!IsSkipped())
      texture_.emplace(ui::ScopeTexture::create());
  }
  // What the texture holds, by way of a framebuffer.
  std::vector<std::uint8_t> read_back() {
    const ui::ScopeTexture& shown = **texture_;
    ui::gl::Framebuffer framebuffer = ui::gl::Framebuffer::make();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           shown.texture().name(), 0);
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(4 * shown.width() * shown.height()));
    glReadPixels(0, 0, shown.width(), shown.height(), GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return rgba;
  }
  void expect_shown(const Picture& picture) {
    const auto shown = (*texture_)->show(picture.frame());
    ASSERT_TRUE(shown) << shown.error().message;
    const auto rgba = read_back();
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(rgba[static_cast<std::size_t>(4 * (y * picture.width + x)) + c],
                      picture.expected(x, y)[c], most_rounded_off())
              << "format " << static_cast<int>(picture.format) << ", " << picture.width << "x"
              << picture.height << ", stride " << picture.stride << ", pixel " << x << ", " << y;
  }

  std::optional<hal::Result<ui::ScopeTexture>> texture_;
};

constexpr std::array formats{PixelFormat::rgb8, PixelFormat::rgba8, PixelFormat::yuyv,
                             PixelFormat::nv12};

TEST_F(ScopeTextureTest, every_format_size_and_stride_gives_its_colours) {
  ASSERT_TRUE(*texture_) << texture_->error().message;
  std::mt19937 random{fresh_seed()};
  for (const PixelFormat format : formats)
    for (const auto& [width, height] :
         {std::pair{1, 1}, std::pair{2, 2}, std::pair{7, 5}, std::pair{64, 33}})
      for (const int padding : {0, 1, 2, 3, 4, 12})
        expect_shown(random_picture(format, width, height, padding, random));
}

// Black, white, and the bars of BT.601 at 75 %, whose codes are in the recommendation.
TEST_F(ScopeTextureTest, known_codes_give_known_colours) {
  ASSERT_TRUE(*texture_) << texture_->error().message;
  struct Known {
    int y, cb, cr;
    std::array<int, 3> rgb;
  };
  constexpr std::array<Known, 5> all{{{16, 128, 128, {0, 0, 0}},
                                      {235, 128, 128, {255, 255, 255}},
                                      {65, 100, 212, {191, 0, 0}},
                                      {112, 72, 58, {0, 191, 0}},
                                      {35, 212, 114, {0, 0, 191}}}};
  for (const Known& known : all) {
    const auto byte = [](int value) { return static_cast<std::byte>(value); };
    const Picture packed{
        PixelFormat::yuyv, 2, 1, 4, {byte(known.y), byte(known.cb), byte(known.y), byte(known.cr)}};
    ASSERT_TRUE((*texture_)->show(packed.frame()));
    const auto rgba = read_back();
    for (std::size_t pixel = 0; pixel < 2; ++pixel)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(rgba[4 * pixel + c], known.rgb[c], 1.5) << "Y " << known.y;
  }
}

TEST_F(ScopeTextureTest, a_short_frame_is_refused_with_both_lengths) {
  ASSERT_TRUE(*texture_) << texture_->error().message;
  std::mt19937 random{1};
  for (const PixelFormat format : formats) {
    Picture picture = random_picture(format, 6, 4, 3, random);
    const std::size_t whole = picture.bytes.size();
    picture.bytes.pop_back();
    EXPECT_THAT((*texture_)->show(picture.frame()),
                FailsWith(hal::ErrorCode::bad_data, std::to_string(whole - 1) + " bytes",
                          "expected " + std::to_string(whole)));
    picture.stride = row_bytes(format, 6) - 1;
    EXPECT_FALSE((*texture_)->show(picture.frame())) << "rows overlap";
  }
}

TEST_F(ScopeTextureTest, keeps_the_framebuffer_and_allocates_nothing_once_it_runs) {
  ASSERT_TRUE(*texture_) << texture_->error().message;
  std::mt19937 random{2};
  for (const PixelFormat format : formats) {
    const Picture picture = random_picture(format, 64, 48, 0, random);
    GLint before = -1;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
    ASSERT_TRUE((*texture_)->show(picture.frame()));
    const auto allocations = allocations_of_this_thread();
    ASSERT_TRUE((*texture_)->show(picture.frame()));
    EXPECT_EQ(allocations_of_this_thread(), allocations);
    GLint after = -2;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &after);
    EXPECT_EQ(after, before);
  }
}

} // namespace
} // namespace octascope::tests
