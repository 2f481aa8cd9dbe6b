#include <random>
#include <string>

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include "hal/linux/libcamera/motion_jpeg.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"

namespace octascope::tests {
namespace {

namespace backend = hal::linux_backend;
constexpr backend::PictureSize size{64, 48};

// Smooth, so that the loss of compression is small.
std::vector<unsigned char> picture() {
  std::vector<unsigned char> rgb;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      for (const int value : {4 * x, 5 * y, 255 - 2 * x})
        rgb.push_back(static_cast<unsigned char>(value));
  return rgb;
}

std::string jpeg() {
  const auto rgb = picture();
  unsigned char* bytes = nullptr;
  unsigned long length = 0;
  void* const handle = tjInitCompress();
  EXPECT_EQ(tjCompress2(handle, rgb.data(), size.width, 0, size.height, TJPF_RGB, &bytes, &length,
                        TJSAMP_422, 95, 0),
            0);
  std::string made{reinterpret_cast<const char*>(bytes), length};
  tjFree(bytes);
  tjDestroy(handle);
  return made;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span{text.data(), text.size()});
}

// As USB cameras send it: without its Huffman tables, which are always the same.
std::string without_tables(std::string jpeg_text) {
  for (;;) {
    const auto at = jpeg_text.find("\xFF\xC4");
    if (at == std::string::npos)
      return jpeg_text;
    const auto high = static_cast<unsigned char>(jpeg_text[at + 2]);
    const auto low = static_cast<unsigned char>(jpeg_text[at + 3]);
    jpeg_text.erase(at, 2 + 256 * std::size_t{high} + low);
  }
}

class MotionJpeg : public testing::Test {
protected:
  hal::Result<> decode(const std::string& text, backend::PictureSize expected = size) {
    return decoder_->decode(bytes_of(text), expected, rgb_);
  }
  void expect_the_picture() {
    const auto original = picture();
    for (std::size_t i = 0; i < original.size(); ++i)
      ASSERT_NEAR(std::to_integer<int>(rgb_[i]), original[i], 12) << i;
  }
  hal::Result<backend::MotionJpegDecoder> decoder_ = backend::MotionJpegDecoder::make();
  std::vector<std::byte> rgb_ = std::vector<std::byte>(3 * 64 * 48);
};

TEST_F(MotionJpeg, is_decoded_to_the_picture_that_went_in) {
  ASSERT_TRUE(decode(jpeg()));
  expect_the_picture();
}

TEST_F(MotionJpeg, needs_no_huffman_tables) {
  const std::string bare = without_tables(jpeg());
  ASSERT_LT(bare.size(), jpeg().size() - 100);
  const auto decoded = decode(bare);
  ASSERT_TRUE(decoded) << decoded.error().message;
  expect_the_picture();
}

TEST_F(MotionJpeg, bears_bytes_after_the_end_and_between_segments) {
  ASSERT_TRUE(decode(jpeg() + std::string(300, '\0')));
  std::string padded = jpeg();
  padded.insert(padded.find("\xFF\xDB"), "\xFF\xFF\xFF");
  const auto decoded = decode(padded);
  ASSERT_TRUE(decoded) << decoded.error().message;
  expect_the_picture();
}

TEST_F(MotionJpeg, refuses_what_is_broken_off_or_of_another_size) {
  const std::string whole = jpeg();
  EXPECT_THAT(decode(whole.substr(0, whole.size() / 2)), FailsWith(hal::ErrorCode::bad_data));
  EXPECT_FALSE(decode(""));
  EXPECT_THAT(decode(whole, {48, 64}), FailsSaying("64x48, expected 48x64"));
  ASSERT_TRUE(decode(whole)) << "and goes on with the next";
}

TEST_F(MotionJpeg, survives_any_bytes) {
  std::mt19937_64 random{fresh_seed()};
  const std::string whole = jpeg();
  for (int i = 0; i < 3000; ++i)
    static_cast<void>(decode(mutate(whole, random)));
  const auto afterwards = decode(whole);
  ASSERT_TRUE(afterwards) << afterwards.error().message;
  expect_the_picture();
}

} // namespace
} // namespace octascope::tests
