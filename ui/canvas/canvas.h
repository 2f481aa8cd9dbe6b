// Collects the text, lines and plates of the heads-up display, to be drawn all at once.
//
// Uses Dear ImGui's draw list and fonts without its global context; the GL part is our own.
// Positions are pixels from the top left corner of the target.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "ui/canvas/fonts.h"
#include "ui/canvas/palette.h"
#include "ui/layout/layout.h"

struct ImDrawList;
struct ImDrawListSharedData;

namespace octascope::ui {

// Threads: one at a time. Allocates only when a picture has more elements than any before it.
class Canvas {
public:
  Canvas();
  ~Canvas();

  // Clears the canvas for a target of that size. The fonts are borrowed until the next begin().
  void begin(const Fonts& fonts, int width, int height);

  // `position` is the upper left corner; the text is as high as its style. Returns its width.
  float text(glm::vec2 position, TextStyle style, Colour colour, std::string_view words);
  // With a dark outline, legible on any picture.
  void shadowed_text(glm::vec2 position, TextStyle style, Colour colour, std::string_view words);
  float text_width(TextStyle style, std::string_view words) const;
  float text_height(TextStyle style) const;

  void line(glm::vec2 from, glm::vec2 to, Colour colour, float width);
  void plate(const Rect& rect, Colour colour, float rounding = 0);
  void frame(const Rect& rect, Colour colour, float width, float rounding = 0);
  // Between two corners, not rounded to pixels; adjacent bars leave no gap.
  void bar(glm::vec2 top_left, glm::vec2 bottom_right, Colour colour);
  // Filled and convex; the corners in order around it.
  void quad(const std::array<glm::vec2, 4>& corners, Colour colour);
  void dot(glm::vec2 centre, float radius, Colour colour);
  void ring(glm::vec2 centre, float radius, Colour colour, float width);
  // Diagonal stripes within the rectangle, no closer than eight pixels.
  void stripes(const Rect& rect, Colour colour, float pitch, float width);

  // What text() set since begin(), for whoever asks whether it lies where it can be read.
  struct Words {
    Rect rect; // within the clipping
    TextStyle style = TextStyle::label;
    Colour colour;
    bool shadowed = false;
  };
  std::span<const Words> words() const { return words_; }

  // Clips drawing to the rectangle during its lifetime.
  class Clip {
  public:
    Clip(Canvas& canvas, const Rect& rect);
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;
    ~Clip();

  private:
    Canvas& canvas_;
  };

  const ImDrawList& list() const { return *list_; }

private:
  float set(glm::vec2 position, TextStyle style, Colour colour, std::string_view words);

  const Fonts* fonts_ = nullptr;
  std::unique_ptr<ImDrawListSharedData> shared_;
  std::unique_ptr<ImDrawList> list_;
  std::vector<Words> words_;
};

} // namespace octascope::ui
