// The display's typeface (Inter), in the sizes that it needs, as one texture.
#pragma once

#include <cstdint>
#include <span>

#include "hal/result.h"
#include "ui/gl/objects.h"

struct ImFont;
struct ImFontAtlas;

namespace octascope::ui {

// What must be seen at once (badge) is at least 16 minutes of arc high for a surgeon two metres
// from a 27-inch screen, the other styles, which are looked up, at least 10: the heights of capital
// letters. Sources: ISO 9241-3 and NUREG-0700 (1.3.1-4) ask for 16′, the former for less where
// reading is incidental; 10′ is twice the smallest letter that an eye of normal acuity can read.
inline constexpr double viewing_distance_mm = 2000;
inline constexpr double screen_diagonal_mm = 27 * 25.4;
inline constexpr double glance_arcmin = 16;
inline constexpr double lookup_arcmin = 10;

enum class TextStyle : std::uint8_t { label, body, value, badge };
inline constexpr int text_style_count = 4;

// Two weights of one typeface, each a file as FreeType reads it; borrowed while fonts are made of
// them.
struct Typeface {
  std::span<const unsigned char> medium;
  std::span<const unsigned char> semi_bold;
};

// The display's, embedded in the program.
Typeface inter();

// Threads: as gl/objects.h.
class Fonts {
public:
  // `unit` as in Layout. ErrorCode::unsupported: this GL takes no texture of that size.
  static hal::Result<Fonts> create(float unit, const Typeface& typeface = inter());
  Fonts(Fonts&& other) noexcept;
  Fonts& operator=(Fonts&& other) noexcept;
  ~Fonts();

  const ImFont& font(TextStyle style) const { return *fonts_[static_cast<int>(style)]; }
  const ImFontAtlas& atlas() const { return *atlas_; }
  GLuint texture() const { return texture_.name(); }

private:
  Fonts();

  ImFontAtlas* atlas_; // owned; ImGui's header stays out of ours
  ImFont* fonts_[text_style_count] = {};
  gl::Texture texture_;
};

} // namespace octascope::ui
