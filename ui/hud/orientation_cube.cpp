#include <array>
#include <cmath>
#include <string_view>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

struct Cube {
  const Camera& camera;
  glm::vec2 centre;
  float half; // of an edge, in pixels

  // Without perspective: a sign, not a picture.
  glm::vec2 pixel(const glm::vec3& point) const {
    return centre + half * glm::vec2{glm::dot(point, camera.right), -glm::dot(point, camera.up)};
  }
  float towards_eye(const glm::vec3& direction) const {
    return -glm::dot(direction, camera.forward);
  }
};

void draw_face(Canvas& canvas, const Cube& cube, int axis, float sign, float unit) {
  glm::vec3 normal{0};
  normal[axis] = sign;
  const float facing = cube.towards_eye(normal);
  if (facing <= 0.01F)
    return;
  glm::vec3 u{0};
  glm::vec3 v{0};
  u[(axis + 1) % 3] = 1;
  v[(axis + 2) % 3] = 1;
  const std::array<glm::vec2, 4> corners{cube.pixel(normal - u - v), cube.pixel(normal + u - v),
                                         cube.pixel(normal + u + v), cube.pixel(normal - u + v)};
  const bool surface = axis == 1 && sign > 0;
  canvas.quad(corners, surface ? palette::cube_surface : palette::panel);
  for (std::size_t i = 0; i < 4; ++i)
    canvas.line(corners[i], corners[(i + 1) % 4], palette::quiet_text, 1.5F * unit);
}

struct Axis {
  int index;
  std::size_t name; // in AxisLabels
  std::string_view letter;
  glm::vec2 side; // of the cube that its name prefers
};

// As in charts: x and y below, z at the left.
constexpr std::array axes{Axis{0, 0, "x", {0, 1}}, Axis{2, 1, "y", {0, 1}},
                          Axis{1, 2, "z", {-1, 0}}};

// Around `middle`, but within the cube's place.
void put_name(Canvas& canvas, const Rect& rect, glm::vec2 middle, std::string_view words) {
  const glm::vec2 size{canvas.text_width(TextStyle::value, words),
                       canvas.text_height(TextStyle::value)};
  const glm::vec2 least{rect.x, rect.y};
  const glm::vec2 most{rect.right(), rect.bottom()};
  canvas.shadowed_text(glm::clamp(middle - size / 2.0F, least, glm::max(least, most - size)),
                       TextStyle::value, palette::text, words);
}

// Beside the middle of the cube's outermost edge along that axis.
void draw_name(Canvas& canvas, const Rect& rect, const Cube& cube, const Axis& axis,
               std::string_view words) {
  glm::vec3 direction{0};
  direction[axis.index] = 1;
  const glm::vec2 along = cube.pixel(direction) - cube.centre;
  const float length = glm::length(along);
  if (length < 0.3F * cube.half) // it points at the eye
    return;
  const glm::vec2 across = glm::vec2{-along.y, along.x} / length;
  float outermost = 0;
  glm::vec2 middle = cube.centre;
  for (const float u : {-1.0F, 1.0F})
    for (const float v : {-1.0F, 1.0F}) {
      glm::vec3 edge{0};
      edge[(axis.index + 1) % 3] = u;
      edge[(axis.index + 2) % 3] = v;
      const glm::vec2 at = cube.pixel(edge);
      // Two lie outermost, on either side: the hint decides.
      const float distance = std::abs(glm::dot(at - cube.centre, across)) +
                             0.01F * glm::dot(at - cube.centre, axis.side);
      if (distance > outermost) {
        outermost = distance;
        middle = at;
      }
    }
  const float outwards = glm::dot(middle - cube.centre, across) < 0 ? -1.0F : 1.0F;
  const float height = canvas.text_height(TextStyle::value);
  put_name(canvas, rect, middle + outwards * 0.55F * height * across, words);
}

// Beyond the cube's sides, where they are seen beside each other.
void draw_sides(Canvas& canvas, const Rect& rect, const Cube& cube, const AxisEnds& ends) {
  struct End {
    glm::vec3 direction;
    std::optional<Side> side;
  };
  for (const auto& [direction, side] :
       {End{{-1, 0, 0}, ends.x_begin}, End{{1, 0, 0}, ends.x_end}, End{{0, 0, -1}, ends.y_begin},
        End{{0, 0, 1}, ends.y_end}}) {
    const glm::vec2 along = cube.pixel(direction) - cube.centre;
    const float length = glm::length(along);
    if (side && length > 0.3F * cube.half)
      put_name(canvas, rect, cube.centre + along * (1.2F * cube.half / length + 0.6F),
               letter_of(*side));
  }
}

// Where the scan begins, as on the microscope's picture.
void draw_first_sample(Canvas& canvas, const Cube& cube, float unit) {
  constexpr glm::vec3 first{-1, 1, -1};
  bool seen = false;
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 normal{0};
    normal[axis] = first[axis];
    seen = seen || cube.towards_eye(normal) > 0;
  }
  canvas.dot(cube.pixel(first), 5 * unit, seen ? palette::accent : palette::accent.faded(120));
}

} // namespace

void draw_orientation_cube(Canvas& canvas, const Rect& rect, const Camera& camera, float unit,
                           const HudText& text) {
  if (rect.empty())
    return;
  const Cube cube{camera,
                  {static_cast<float>(rect.x) + static_cast<float>(rect.width) / 2,
                   static_cast<float>(rect.y) + static_cast<float>(rect.height) / 2},
                  0.2F * static_cast<float>(rect.width)};
  for (const int axis : {0, 1, 2})
    for (const float sign : {-1.0F, 1.0F})
      draw_face(canvas, cube, axis, sign, unit);
  draw_first_sample(canvas, cube, unit);
  if (text.ends.said()) {
    draw_sides(canvas, rect, cube, text.ends);
    return;
  }
  for (const Axis& axis : axes) {
    const std::string& own = text.labels.names[axis.name];
    draw_name(canvas, rect, cube, axis, own.empty() ? axis.letter : std::string_view{own});
  }
}

} // namespace octascope::ui
