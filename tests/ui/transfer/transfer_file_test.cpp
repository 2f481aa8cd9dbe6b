// Look-up tables from files, good and bad.
#include <cstdio>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "tests/support/fails_with.h"
#include "tests/support/files/mutation.h"
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

// The least profile that libpng writes: a header and no tags.
void add_profile(png_structp png, png_infop info) {
  std::string profile(132, '\0');
  const auto put = [&](std::size_t at, std::string_view bytes) {
    profile.replace(at, bytes.size(), bytes);
  };
  const bool grey = (png_get_color_type(png, info) & PNG_COLOR_MASK_COLOR) == 0;
  put(3, "\x84");
  put(12, "mntr");
  put(16, grey ? "GRAY" : "RGB ");
  put(20, "XYZ ");
  put(36, "acsp");
  put(68, {"\0\0\xf6\xd6\0\1\0\0\0\0\xd3\x2d", 12}); // D50
  png_set_iCCP(png, info, "none", PNG_COMPRESSION_TYPE_BASE,
               reinterpret_cast<png_const_bytep>(profile.data()), 132);
  EXPECT_NE(png_get_valid(png, info, PNG_INFO_iCCP), 0U);
}

// With what a file can say about its colours, by libpng's own writer.
struct ColourChunk {
  const char* name;
  void (*add)(png_structp, png_infop);
};
const ColourChunk colour_chunks[] = {
    {"none", [](png_structp, png_infop) {}},
    {"gAMA of a screen", [](png_structp png, png_infop info) { png_set_gAMA(png, info, 0.45455); }},
    {"gAMA of light", [](png_structp png, png_infop info) { png_set_gAMA(png, info, 1); }},
    {"sRGB",
     [](png_structp png, png_infop info) {
       png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_SATURATION);
     }},
    {"iCCP", add_profile},
    {"cHRM of another screen", [](png_structp png, png_infop info) {
       png_set_gAMA(png, info, 0.55);
       png_set_cHRM(png, info, 0.3127, 0.329, 0.68, 0.32, 0.265, 0.69, 0.15, 0.06);
     }}};

// A strip of one row; `values` are those of the file, of `bits` each.
std::filesystem::path write_strip(const std::filesystem::path& file, int bits, int colour_type,
                                  int width, const std::vector<int>& values,
                                  const ColourChunk& chunk) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, out);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), 1, bits, colour_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  chunk.add(png, info);
  png_write_info(png, info);
  std::vector<png_byte> row;
  for (const int value : values) {
    if (bits == 16)
      row.push_back(static_cast<png_byte>(value >> 8));
    row.push_back(static_cast<png_byte>(value));
  }
  png_set_packing(png);
  png_write_row(png, row.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(out);
  return file;
}

struct Strip {
  int bits;
  int colour_type;
  std::vector<int> values; // of two pixels or more
};

TEST_F(LookUpTableFile, of_a_strip_is_value_by_greatest_whatever_it_says_of_colour) {
  const Strip strips[] = {{2, PNG_COLOR_TYPE_GRAY, {0, 1, 2, 3}},
                          {8, PNG_COLOR_TYPE_GRAY, {0, 1, 100, 127, 128, 254, 255}},
                          {16, PNG_COLOR_TYPE_GRAY, {0, 1, 257, 30000, 32767, 32768, 65534, 65535}},
                          {8, PNG_COLOR_TYPE_GRAY_ALPHA, {200, 7, 100, 0, 50, 255}},
                          {16, PNG_COLOR_TYPE_GRAY_ALPHA, {40000, 1, 65535, 0, 123, 65534}},
                          {8, PNG_COLOR_TYPE_RGB, {0, 50, 100, 150, 200, 250}},
                          {16, PNG_COLOR_TYPE_RGB, {1, 300, 1000, 30001, 50000, 65535}},
                          {8, PNG_COLOR_TYPE_RGB_ALPHA, {10, 20, 30, 1, 40, 50, 60, 128}},
                          {16, PNG_COLOR_TYPE_RGB_ALPHA, {1, 2, 3, 4, 60000, 300, 77, 30000}}};
  for (const Strip& strip : strips)
    for (const ColourChunk& chunk : colour_chunks) {
      const bool grey = (strip.colour_type & PNG_COLOR_MASK_COLOR) == 0;
      const bool opacity = (strip.colour_type & PNG_COLOR_MASK_ALPHA) != 0;
      const std::size_t channels = (grey ? 1U : 3U) + (opacity ? 1U : 0U);
      const std::size_t width = strip.values.size() / channels;
      const auto table =
          ui::read_look_up_table(write_strip(folder_ / "t.png", strip.bits, strip.colour_type,
                                             static_cast<int>(width), strip.values, chunk));
      ASSERT_TRUE(table) << chunk.name << table.error().message;
      const auto value = [&](std::size_t entry, std::size_t channel) {
        return static_cast<float>(strip.values[entry * channels + channel]) /
               static_cast<float>((1 << strip.bits) - 1);
      };
      ASSERT_EQ(table->opacities.size(), width);
      ASSERT_EQ(table->colours.has_value(), channels > 1);
      for (std::size_t entry = 0; entry < width; ++entry) {
        const std::string place = fmt::format("{} bits, {}, {}", strip.bits, chunk.name, entry);
        if (grey || opacity) {
          EXPECT_EQ(table->opacities[entry], value(entry, channels - 1)) << place;
        }
        if (channels > 1) {
          EXPECT_EQ((*table->colours)[entry], (Colour{value(entry, 0), value(entry, grey ? 0 : 1),
                                                      value(entry, grey ? 0 : 2)}))
              << place;
        }
      }
    }
}

TEST_F(LookUpTableFile, that_is_no_picture_is_told_as_what_it_is) {
  write_strip(folder_ / "t.png", 8, PNG_COLOR_TYPE_GRAY, 4, {0, 1, 2, 3}, colour_chunks[0]);
  const std::string whole = whole_file(folder_ / "t.png");
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{20}, whole.size() - 30})
    EXPECT_THAT(ui::read_look_up_table(folder_.write("cut.png", whole.substr(0, bytes))),
                FailsSaying("cut.png: found no PNG picture"))
        << bytes;
  EXPECT_THAT(ui::read_look_up_table(folder_ / "none.png"), FailsWith(hal::ErrorCode::absent));
  std::filesystem::create_directory(folder_ / "folder.png");
  EXPECT_THAT(ui::read_look_up_table(folder_ / "folder.png"), FailsSaying("is a directory"));
  const std::vector<int> wide(4097, 1);
  EXPECT_THAT(ui::read_look_up_table(write_strip(folder_ / "w.png", 8, PNG_COLOR_TYPE_GRAY, 4097,
                                                 wide, colour_chunks[0])),
              FailsSaying("found 4097x1 pixels"));
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
