// Look-up tables from files, good and bad.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "ui/transfer/look_up_table_file.h"

namespace octascope::tests {
namespace {

using testing::ElementsAre;
using Colour = ui::TransferTable::Colour;

class LookUpTableFile : public testing::Test {
protected:
  auto text(std::string_view words) {
    return ui::read_look_up_table(folder_.write("t.csv", words));
  }
  auto png(int width, int height, png_uint_32 format, const std::vector<std::uint8_t>& pixels) {
    const auto file = folder_ / "t.PNG";
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = format;
    EXPECT_NE(png_image_write_to_file(&image, file.c_str(), 0, pixels.data(), 0, nullptr), 0);
    return ui::read_look_up_table(file);
  }
  ScratchFolder folder_;
};

TEST_F(LookUpTableFile, of_opacities) {
  const auto table = text("# from a colleague\r\n0\r\n\r\n0.25 # here\r\n1e0\r\n");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_THAT(table->opacities, ElementsAre(0, 0.25F, 1));
  EXPECT_FALSE(table->colours);
}

TEST_F(LookUpTableFile, of_colours_with_any_usual_separator) {
  const auto table = text("0,0.5,1,0\n0.25; 0.5 ;0.75;1\n1\t1 0  0.5\n");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_THAT(table->opacities, ElementsAre(0, 1, 0.5F));
  ASSERT_TRUE(table->colours);
  EXPECT_THAT(*table->colours,
              ElementsAre(Colour{0, 0.5F, 1}, Colour{0.25F, 0.5F, 0.75F}, Colour{1, 1, 0}));
}

TEST_F(LookUpTableFile, in_error_is_refused_with_its_line) {
  EXPECT_THAT(text("0\nx\n"), FailsSaying("t.csv:2: found \"x\", expected 1 or 4 finite numbers"));
  EXPECT_THAT(text("0\n\n1,1\n"), FailsSaying("t.csv:3: found \"1,1\""));
  EXPECT_THAT(text("0,0,0,0\n1\n"),
              FailsSaying("t.csv:2: found \"1\", expected 4 numbers as in line 1"));
  EXPECT_THAT(text("0,0,0,0\n1,,1,1\n"), FailsSaying("t.csv:2"));
  EXPECT_THAT(text("0,0,0,0\n1,1,1,\n"), FailsSaying("t.csv:2"));
  EXPECT_THAT(text("0\nnan\n"), FailsSaying("t.csv:2"));
  EXPECT_THAT(text("0\n255\n"),
              FailsSaying("t.csv:2: found 255, expected numbers from 0 to 1; divide"));
  EXPECT_THAT(text("0\n-0.1\n"), FailsSaying("t.csv:2: found -0.1"));
  EXPECT_THAT(text("0.5\n"), FailsSaying("found 1 entries, expected 2 to 4096"));
  EXPECT_THAT(text("# nothing\n"), FailsSaying("found 0 entries"));
  EXPECT_THAT(text(""), FailsSaying("is empty"));
  std::string long_one;
  for (int i = 0; i < 4097; ++i)
    long_one += "0\n";
  EXPECT_THAT(text(long_one), FailsSaying("t.csv:4097: found \"0\", expected the end"));
  long_one.resize(long_one.size() - 2);
  EXPECT_TRUE(text(long_one)) << "4096 are fine";
  EXPECT_THAT(ui::read_look_up_table(folder_ / "none.csv"), FailsWith(hal::ErrorCode::absent));
}

TEST_F(LookUpTableFile, of_a_grey_strip_is_opacity) {
  const auto table = png(3, 2, PNG_FORMAT_GRAY, {0, 51, 255, 0, 51, 255});
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_THAT(table->opacities, ElementsAre(0, 0.2F, 1));
  EXPECT_FALSE(table->colours);
}

TEST_F(LookUpTableFile, of_a_coloured_strip_has_the_window_s_ramp) {
  const auto table = png(1, 3, PNG_FORMAT_RGB, {0, 0, 0, 255, 51, 0, 255, 255, 255});
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_THAT(table->opacities, ElementsAre(0, 0.5F, 1));
  ASSERT_TRUE(table->colours);
  EXPECT_EQ((*table->colours)[1], (Colour{1, 0.2F, 0}));
}

TEST_F(LookUpTableFile, of_a_strip_with_transparency_has_both) {
  const auto table = png(2, 1, PNG_FORMAT_RGBA, {255, 0, 0, 51, 0, 255, 0, 255});
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_THAT(table->opacities, ElementsAre(0.2F, 1));
  ASSERT_TRUE(table->colours);
  EXPECT_EQ(table->colours->front(), (Colour{1, 0, 0}));
}

TEST_F(LookUpTableFile, of_a_picture_is_refused) {
  EXPECT_THAT(png(2, 2, PNG_FORMAT_GRAY, {0, 1, 2, 3}),
              FailsSaying("row 2 other than row 1 at pixel 1"));
  EXPECT_THAT(png(1, 1, PNG_FORMAT_GRAY, {0}), FailsSaying("1x1 pixels"));
  folder_.write("no.png", "no picture");
  EXPECT_THAT(ui::read_look_up_table(folder_ / "no.png"), FailsSaying("no.png"));
}

} // namespace
} // namespace octascope::tests
