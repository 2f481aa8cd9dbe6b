#include "ui/canvas/canvas.h"

#include <algorithm>

#include <glm/common.hpp>
#include <imgui.h>
#include <imgui_internal.h>

namespace octascope::ui {

namespace {

ImU32 packed(Colour c) {
  return IM_COL32(c.r, c.g, c.b, c.a);
}
ImVec2 to_im(glm::vec2 p) {
  return {p.x, p.y};
}
ImVec2 top_left(const Rect& r) {
  return {static_cast<float>(r.x), static_cast<float>(r.y)};
}
ImVec2 bottom_right(const Rect& r) {
  return {static_cast<float>(r.right()), static_cast<float>(r.bottom())};
}

} // namespace

Canvas::Canvas()
    : shared_{std::make_unique<ImDrawListSharedData>()}, list_{std::make_unique<ImDrawList>(
                                                             shared_.get())} {
  shared_->InitialFlags = ImDrawListFlags_AntiAliasedLines |
                          ImDrawListFlags_AntiAliasedLinesUseTex | ImDrawListFlags_AntiAliasedFill;
  shared_->SetCircleTessellationMaxError(0.25F);
  shared_->CurveTessellationTol = 1.25F;
}

Canvas::~Canvas() = default;

void Canvas::begin(const Fonts& fonts, int width, int height) {
  fonts_ = &fonts;
  words_.clear();
  shared_->TexUvWhitePixel = fonts.atlas().TexUvWhitePixel;
  shared_->TexUvLines = fonts.atlas().TexUvLines;
  shared_->ClipRectFullscreen = ImVec4{0, 0, static_cast<float>(width), static_cast<float>(height)};
  list_->_ResetForNewFrame();
  list_->PushTextureID(fonts.atlas().TexID);
  list_->PushClipRectFullScreen();
}

float Canvas::set(glm::vec2 position, TextStyle style, Colour colour, std::string_view words) {
  const ImFont& font = fonts_->font(style);
  list_->AddText(&font, font.FontSize, to_im(glm::round(position)), packed(colour), words.data(),
                 words.data() + words.size());
  return text_width(style, words);
}

float Canvas::text(glm::vec2 position, TextStyle style, Colour colour, std::string_view words) {
  if (words.empty())
    return 0;
  const float width = set(position, style, colour, words);
  const ImVec4& clip = list_->_ClipRectStack.back();
  const glm::vec2 from = glm::max(glm::floor(position), {clip.x, clip.y});
  const glm::vec2 to =
      glm::min(glm::ceil(position + glm::vec2{width, text_height(style)}), {clip.z, clip.w});
  words_.push_back({{static_cast<int>(from.x), static_cast<int>(from.y),
                     static_cast<int>(to.x - from.x), static_cast<int>(to.y - from.y)},
                    style,
                    colour,
                    false});
  return width;
}

void Canvas::shadowed_text(glm::vec2 position, TextStyle style, Colour colour,
                           std::string_view words) {
  if (words.empty())
    return;
  const float reach = std::max(1.0F, text_height(style) / 16);
  for (const glm::vec2 shift :
       {glm::vec2{1, 1}, glm::vec2{-1, 1}, glm::vec2{1, -1}, glm::vec2{-1, -1}})
    set(position + reach * shift, style, palette::ink.faded(200), words);
  text(position, style, colour, words);
  words_.back().shadowed = true;
}

float Canvas::text_width(TextStyle style, std::string_view words) const {
  if (words.empty()) // ImGui would look for a text's end
    return 0;
  const ImFont& font = fonts_->font(style);
  return font.CalcTextSizeA(font.FontSize, FLT_MAX, 0, words.data(), words.data() + words.size()).x;
}

float Canvas::text_height(TextStyle style) const {
  return fonts_->font(style).FontSize;
}

void Canvas::line(glm::vec2 from, glm::vec2 to, Colour colour, float width) {
  list_->AddLine(to_im(from), to_im(to), packed(colour), width);
}

void Canvas::plate(const Rect& rect, Colour colour, float rounding) {
  list_->AddRectFilled(top_left(rect), bottom_right(rect), packed(colour), rounding);
}

void Canvas::frame(const Rect& rect, Colour colour, float width, float rounding) {
  const ImVec2 inset{width / 2, width / 2};
  list_->AddRect({top_left(rect).x + inset.x, top_left(rect).y + inset.y},
                 {bottom_right(rect).x - inset.x, bottom_right(rect).y - inset.y}, packed(colour),
                 rounding, 0, width);
}

void Canvas::bar(glm::vec2 top_left, glm::vec2 bottom_right, Colour colour) {
  list_->AddRectFilled(to_im(top_left), to_im(bottom_right), packed(colour));
}

void Canvas::quad(const std::array<glm::vec2, 4>& corners, Colour colour) {
  list_->AddQuadFilled(to_im(corners[0]), to_im(corners[1]), to_im(corners[2]), to_im(corners[3]),
                       packed(colour));
}

void Canvas::dot(glm::vec2 centre, float radius, Colour colour) {
  list_->AddCircleFilled(to_im(centre), radius, packed(colour));
}

void Canvas::ring(glm::vec2 centre, float radius, Colour colour, float width) {
  list_->AddCircle(to_im(centre), radius, packed(colour), 0, width);
}

void Canvas::stripes(const Rect& rect, Colour colour, float pitch, float width) {
  constexpr float least_pitch = 8; // of which the longest picture has a few thousand
  pitch = std::max(pitch, least_pitch);
  const Clip clip{*this, rect};
  const auto height = static_cast<float>(rect.height);
  const auto bottom = static_cast<float>(rect.bottom());
  for (float x = static_cast<float>(rect.x) - height; x < static_cast<float>(rect.right());
       x += pitch)
    line({x, bottom}, {x + height, bottom - height}, colour, width);
}

Canvas::Clip::Clip(Canvas& canvas, const Rect& rect) : canvas_{canvas} {
  canvas_.list_->PushClipRect(top_left(rect), bottom_right(rect), true);
}

Canvas::Clip::~Clip() {
  canvas_.list_->PopClipRect();
}

} // namespace octascope::ui
