#include "ui/hud/fonts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "embedded_fonts.h"
#include <imgui.h>
#include <imgui_freetype.h>

#include "ui/layout/layout.h"

namespace octascope::ui {

namespace {

constexpr float badge_pixels = 34; // the largest, on a picture 720 high

struct StyleFace {
  std::span<const unsigned char> file;
  float pixels; // on a picture 720 high
};

std::array<StyleFace, text_style_count> faces(const Typeface& typeface) {
  return {{{typeface.medium, 22},
           {typeface.medium, 24},
           {typeface.semi_bold, 28},
           {typeface.semi_bold, badge_pixels}}};
}

// ImGui's FreeType builder writes a glyph of more pixels past the end of its buffer (256 KiB, four
// bytes a pixel). No glyph is larger than its line each way. All of them, at the largest unit, take
// a texture of 2048 × 8192, which every GL has that takes pictures 4320 pixels high.
constexpr float most_glyph_pixels = 65536;
constexpr float largest_line = largest_unit * badge_pixels;
static_assert(largest_line * largest_line <= most_glyph_pixels);

// Latin-1, dashes, ellipsis, minus.
constexpr std::array<ImWchar, 7> glyph_ranges{0x20, 0xFF, 0x2010, 0x2026, 0x2212, 0x2212, 0};

} // namespace

Typeface inter() {
  // Each array has a zero behind its file.
  return {
      std::span{fonts::inter_medium_otf_bytes}.first<sizeof fonts::inter_medium_otf_bytes - 1>(),
      std::span{fonts::inter_semibold_otf_bytes}
          .first<sizeof fonts::inter_semibold_otf_bytes - 1>()};
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
  int next = 0;
  for (const StyleFace& face : faces(typeface)) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.GlyphRanges = glyph_ranges.data();
    // Below ten pixels no hinting saves a letter.
    const float pixels = std::max(10.0F, std::ceil(face.pixels * unit));
    // ImGui takes a mutable pointer and does not write to data that it does not own.
    result.fonts_[next++] =
        atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(face.file.data()),
                                   static_cast<int>(face.file.size()), pixels, &config);
  }
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
