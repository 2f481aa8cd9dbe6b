// The display's typeface (Inter), in the sizes that it needs, as one texture.
#pragma once

#include <cstdint>

#include "hal/result.h"
#include "ui/gl/objects.h"

struct ImFont;
struct ImFontAtlas;

namespace octascope::ui {

enum class TextStyle : std::uint8_t { label, body, value, badge };
inline constexpr int text_style_count = 4;

// Threads: as gl/objects.h.
class Fonts {
public:
  // `unit` as in Layout: value and badge text is 22 or more pixels high on a picture of 720.
  static hal::Result<Fonts> create(float unit);
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
