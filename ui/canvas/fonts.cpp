#include "ui/canvas/fonts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "embedded_fonts.h"
#include <imgui.h>
#include <imgui_freetype.h>

#include "ui/layout/layout.h"

namespace octascope::ui {

namespace {

constexpr float badge_pixels = 42; // the largest, on a picture 720 high
constexpr std::array<float, text_style_count> pixels_at_720{26, 30, badge_pixels};

// ImGui's FreeType builder writes a glyph of more pixels past the end of its buffer (256 KiB, four
// bytes a pixel). No glyph is larger than its line each way. All of them, at the largest unit, take
// a texture of 2048 × 8192, which every GL has that takes pictures 4320 pixels high.
constexpr float most_glyph_pixels = 65536;
constexpr float largest_line = largest_unit * badge_pixels;
static_assert(largest_line * largest_line <= most_glyph_pixels);

constexpr ImWchar not_drawable = 0x25A1; // a square

// Latin-1, dashes, ellipsis, minus, what stands for all others.
constexpr std::array<ImWchar, 9> own_words{0x20,   0xFF,         0x2010,       0x2026, 0x2212,
                                           0x2212, not_drawable, not_drawable, 0};
// Those, Latin of all Europe (A, Romanian), Greek, Cyrillic (Russian to Ukrainian).
constexpr std::array<ImWchar, 17> names{0x20,   0x17F,  0x218,        0x21B,        0x384,  0x3CE,
                                        0x400,  0x45F,  0x490,        0x491,        0x2010, 0x2026,
                                        0x2212, 0x2212, not_drawable, not_drawable, 0};

} // namespace

Typeface inter() {
  // Each array has a zero behind its file.
  return {
      std::span{fonts::inter_medium_otf_bytes}.first<sizeof fonts::inter_medium_otf_bytes - 1>(),
      std::span{fonts::inter_semibold_otf_bytes}
          .first<sizeof fonts::inter_semibold_otf_bytes - 1>()};
}

double mm_per_pixel(int width, int height) {
  constexpr double screen_height_mm = screen_diagonal_mm * 9 / 18.3576; // of 16:9
  return 9 * width > 16 * height ? screen_height_mm / height
                                 : screen_diagonal_mm / std::hypot(width, height);
}

// Below ten pixels no hinting saves a letter.
float line_pixels(TextStyle style, float unit) {
  return std::max(10.0F, std::ceil(pixels_at_720[static_cast<std::size_t>(style)] * unit));
}

Fonts::Fonts() : atlas_{IM_NEW(ImFontAtlas)()} {}

void Fonts::Destroy::operator()(ImFontAtlas* atlas) const {
  IM_DELETE(atlas);
}

hal::Result<Fonts> Fonts::create(float unit, const Typeface& typeface) {
  if (!(unit > 0 && unit <= largest_unit))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "heads-up display: letters are scaled by {}, expected more than 0 and at most "
                     "{}",
                     unit, largest_unit);
  Fonts result;
  ImFontAtlas& atlas = *result.atlas_;
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  atlas.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  // GLES 3 promises textures of 2048 × 2048, which a display 2160 pixels high needs.
  atlas.TexDesiredWidth = unit > 1.2F ? 2048 : 1024;
  for (int i = 0; i < text_style_count; ++i) {
    const auto style = static_cast<TextStyle>(i);
    const std::span file = style == TextStyle::label ? typeface.medium : typeface.semi_bold;
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.GlyphRanges = style == TextStyle::badge ? own_words.data() : names.data();
    // ImGui takes a mutable pointer and does not write to data that it does not own.
    result.fonts_[i] = atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(file.data()),
                                                  static_cast<int>(file.size()),
                                                  line_pixels(style, unit), &config);
  }
  for (ImFont* font : result.fonts_)
    font->FallbackChar = not_drawable;
  unsigned char* coverage = nullptr;
  int width = 0;
  int height = 0;
  atlas.GetTexDataAsAlpha8(&coverage, &width, &height);
  if (coverage == nullptr)
    return hal::fail(hal::ErrorCode::system,
                     "heads-up display: FreeType builds no glyphs from the "
                     "embedded fonts; the program is damaged, install it anew");
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (width > largest || height > largest)
    return hal::fail(hal::ErrorCode::unsupported,
                     "heads-up display: found that this GL takes textures up to {}, expected {}x{} "
                     "for the glyphs of this size; choose a smaller one",
                     largest, width, height);
  result.texture_ = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, result.texture_.name());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8, width, height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, coverage);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  atlas.SetTexID(
      reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(result.texture_.name())));
  atlas.ClearTexData();
  return result;
}

} // namespace octascope::ui
