// The display's typeface (Inter) in all required sizes, as one texture.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "hal/result.h"
#include "ui/gl/objects.h"

struct ImFont;
struct ImFontAtlas;

namespace octascope::ui {

// Capital heights for a surgeon two metres from a 27-inch screen of 16:9 (597 × 336 mm): at least 20
// minutes of arc for what must be read at once (badge), at least 12 for everything else. ISO 9241-3
// and NUREG-0700 (1.3.1-4) ask for 16′ at least, 20′ to 22′ where reading matters; 12′ is well over
// twice the smallest letter that an eye of normal acuity can read.
inline constexpr double viewing_distance_mm = 2000;
inline constexpr double screen_diagonal_mm = 27 * 25.4;
inline constexpr double glance_arcmin = 20;
inline constexpr double lookup_arcmin = 12;

// Of a picture on the screen that it fills: one as high as that of 16:9 if it is wider, else one of
// the same diagonal (4:3: 549 × 411 mm).
double mm_per_pixel(int width, int height);

enum class TextStyle : std::uint8_t { label, value, badge };
inline constexpr int text_style_count = 3;

// The height of a line of text, in pixels; `unit` as in Layout.
float line_pixels(TextStyle style, float unit);

// Two weights of one typeface, as font files that FreeType reads. Borrowed by Fonts::create().
struct Typeface {
  std::span<const unsigned char> medium;
  std::span<const unsigned char> semi_bold;
};

// The built-in typeface, embedded in the program.
Typeface inter();

// Latin, Greek and Cyrillic letters in the styles that names are set in, label and value; a badge
// has the program's own words, in Latin. What is not there is drawn as a square, U+25A1.
//
// Threads: as gl/objects.h.
class Fonts {
public:
  // `unit` as in Layout. ErrorCode::invalid_argument: the letters would be larger than the atlas
  // can hold. ErrorCode::unsupported: this GL does not support so large a texture.
  // ErrorCode::system: FreeType cannot build the glyphs.
  static hal::Result<Fonts> create(float unit, const Typeface& typeface = inter());

  const ImFont& font(TextStyle style) const { return *fonts_[static_cast<int>(style)]; }
  const ImFontAtlas& atlas() const { return *atlas_; }
  GLuint texture() const { return texture_.name(); }

private:
  struct Destroy {
    void operator()(ImFontAtlas* atlas) const;
  };
  Fonts();

  std::unique_ptr<ImFontAtlas, Destroy> atlas_; // deleter: keeps ImGui's header out of this one
  ImFont* fonts_[text_style_count] = {};
  gl::Texture texture_;
};

} // namespace octascope::ui
