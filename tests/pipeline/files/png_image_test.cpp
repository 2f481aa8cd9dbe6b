#include <gtest/gtest.h>

#include "pipeline/files/png_image.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::pipeline {
namespace {

TEST(PngImage, comes_back_as_it_went) {
  const tests::ScratchFolder folder;
  for (const int channels : {1, 3}) {
    Image image{13, 7, channels};
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = static_cast<std::uint8_t>(i * 37);
    ASSERT_TRUE(write_png(folder / "i.png", image));
    const auto read = read_png(folder / "i.png");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, image);
  }
  EXPECT_EQ(folder.count(), 1);
}

TEST(PngImage, refuses_what_is_none) {
  const tests::ScratchFolder folder;
  EXPECT_EQ(read_png(folder / "missing.png").error().code, hal::ErrorCode::absent);
  EXPECT_EQ(read_png(folder.write("text.png", "not a picture")).error().code,
            hal::ErrorCode::bad_data);
  EXPECT_FALSE(write_png(folder / "i.png", Image{}));
  EXPECT_FALSE(write_png(folder / "i.png", Image{2, 2, 2}));
  Image short_image{2, 2, 3};
  short_image.pixels.pop_back();
  EXPECT_FALSE(write_png(folder / "i.png", short_image));
  EXPECT_FALSE(write_png(folder / "no/such/i.png", Image{2, 2, 3}));
}

} // namespace
} // namespace octascope::pipeline
