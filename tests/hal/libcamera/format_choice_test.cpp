#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/format_choice.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::tests {
namespace {

namespace backend = hal::linux_backend;
using backend::CameraFormat;
using backend::Encoding;
using backend::PictureSize;

std::uint32_t code(const char (&name)[5]) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(name[i])) << (8 * i);
  return value;
}

CameraFormat sizes(const char (&name)[5], std::vector<PictureSize> offered) {
  return {code(name), std::move(offered), {}};
}

std::vector<Encoding> encodings(const std::vector<CameraFormat>& offered,
                                const hal::ScopeCameraConfig& wanted) {
  std::vector<Encoding> chosen;
  for (const backend::FormatCandidate& format : choose_formats(offered, wanted))
    chosen.push_back(format.encoding);
  return chosen;
}

TEST(FormatChoice, knows_what_the_display_draws) {
  EXPECT_EQ(backend::encoding_of(code("NV12")), Encoding::nv12);
  EXPECT_EQ(backend::encoding_of(code("YUYV")), Encoding::yuyv);
  EXPECT_EQ(backend::encoding_of(code("BG24")), Encoding::rgb8) << "red first in memory";
  EXPECT_EQ(backend::encoding_of(code("XB24")), Encoding::rgba8);
  EXPECT_EQ(backend::encoding_of(code("AB24")), Encoding::rgba8);
  EXPECT_EQ(backend::encoding_of(code("MJPG")), Encoding::motion_jpeg);
  EXPECT_FALSE(backend::encoding_of(code("RG24"))) << "blue first: would be drawn wrong";
  EXPECT_FALSE(backend::encoding_of(0));
}

TEST(FormatChoice, prefers_few_bytes_of_the_requested_size) {
  const std::vector<PictureSize> vga{{320, 240}, {640, 480}};
  EXPECT_EQ(encodings({sizes("MJPG", vga), sizes("XB24", vga), sizes("BG24", vga),
                       sizes("YUYV", vga), sizes("NV12", vga), sizes("RG10", vga)},
                      {640, 480, 30}),
            (std::vector{Encoding::nv12, Encoding::yuyv, Encoding::rgb8, Encoding::motion_jpeg,
                         Encoding::rgba8}))
      << "RGBA of this size and rate is more than USB 2 carries";
  EXPECT_EQ(encodings({sizes("NV12", {{320, 240}}), sizes("MJPG", vga)}, {640, 480, 30}).front(),
            Encoding::motion_jpeg)
      << "the size comes first";
}

TEST(FormatChoice, takes_motion_jpeg_where_raw_pictures_are_too_much_for_usb) {
  const std::vector<PictureSize> full{{1920, 1080}};
  EXPECT_EQ(encodings({sizes("YUYV", full), sizes("MJPG", full)}, {1920, 1080, 30}).front(),
            Encoding::motion_jpeg);
  EXPECT_EQ(encodings({sizes("YUYV", full), sizes("MJPG", full)}, {1920, 1080, 5}).front(),
            Encoding::yuyv);
  EXPECT_EQ(encodings({sizes("NV12", full)}, {1920, 1080, 30}), std::vector{Encoding::nv12})
      << "a board camera offers no JPEG";
}

TEST(FormatChoice, a_camera_that_scales_gives_the_requested_size) {
  const CameraFormat scaling{code("NV12"), {}, {{{64, 48}, {1920, 1080}}}};
  EXPECT_EQ(backend::choose_formats({scaling}, {800, 600, 30})[0].size, (PictureSize{800, 600}));
  EXPECT_EQ(backend::choose_formats({scaling}, {8000, 6, 30})[0].size, (PictureSize{1920, 48}));
}

// Whatever a camera offers: each choice is one of its offers, none is better than the first.
TEST(FormatChoice, holds_for_any_offer) {
  std::mt19937_64 random{fresh_seed()};
  const auto below = [&](int end) {
    return static_cast<int>(random() % static_cast<unsigned>(end));
  };
  const std::uint32_t codes[] = {
      code("NV12"), code("YUYV"), code("BG24"), code("XB24"), code("MJPG"), code("RG24"), 0,
      0xFFFFFFFF};
  for (int round = 0; round < 3000; ++round) {
    std::vector<CameraFormat> offers;
    for (int i = below(6); i > 0; --i) {
      CameraFormat offer{codes[below(8)], {}, {}};
      for (int j = below(4); j > 0; --j)
        offer.sizes.push_back({below(3000) - 5, below(3000) - 5});
      if (below(4) == 0)
        offer.range = {{below(500) - 5, below(500) - 5}, {below(3000) - 5, below(3000) - 5}};
      offers.push_back(offer);
    }
    const hal::ScopeCameraConfig wanted{1 + below(4000), 1 + below(4000), 1.0 + below(120)};
    const auto chosen = choose_formats(offers, wanted);
    int last = -1;
    for (const backend::FormatCandidate& format : chosen) {
      EXPECT_EQ(backend::encoding_of(format.fourcc), format.encoding);
      EXPECT_GT(format.size.width, 0);
      EXPECT_GT(format.size.height, 0);
      EXPECT_TRUE(std::any_of(offers.begin(), offers.end(), [&](const CameraFormat& offer) {
        const auto& r = offer.range;
        return offer.fourcc == format.fourcc &&
               (r ? format.size.width >= r->smallest.width &&
                        format.size.width <= r->largest.width &&
                        format.size.height >= r->smallest.height &&
                        format.size.height <= r->largest.height
                  : std::count(offer.sizes.begin(), offer.sizes.end(), format.size) > 0);
      }));
      const int distance =
          std::abs(format.size.width - wanted.width) + std::abs(format.size.height - wanted.height);
      EXPECT_GE(distance, last);
      last = distance;
    }
  }
}

TEST(FormatChoice, names_formats_for_messages) {
  EXPECT_EQ(backend::format_name(code("NV12")), "NV12");
  EXPECT_EQ(backend::format_name(1), "0x00000001");
}

} // namespace
} // namespace octascope::tests
