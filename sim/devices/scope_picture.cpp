#include "sim/devices/scope_picture.h"

#include <algorithm>
#include <cmath>

namespace octascope::sim {
namespace {

// From the surface to the lamps, of unit length: a little to the upper left.
constexpr float lamp_x = -0.28F;
constexpr float lamp_y = -0.36F;
constexpr float lamp_z = 0.89F;
constexpr float ambient = 0.35F;
constexpr float steepest = 1.2F; // edges are drawn as slopes, not as cliffs

struct Shade {
  float diffuse;
  float mirror;
};

// Lambert's law and, for the mirror image, Blinn's half vector with the view straight from above.
Shade shade_of(float slope_x, float slope_y) {
  const float sx = std::clamp(slope_x, -steepest, steepest);
  const float sy = std::clamp(slope_y, -steepest, steepest);
  const float scale = 1 / std::sqrt(sx * sx + sy * sy + 1);
  const float towards_lamp = (-sx * lamp_x - sy * lamp_y + lamp_z) * scale;
  const float half_z = (1 + lamp_z) / std::sqrt(2 + 2 * lamp_z);
  const float half_x = lamp_x / std::sqrt(2 + 2 * lamp_z);
  const float half_y = lamp_y / std::sqrt(2 + 2 * lamp_z);
  const float towards_half = (-sx * half_x - sy * half_y + half_z) * scale;
  return {ambient + (1 - ambient) * std::max(towards_lamp, 0.0F) / lamp_z,
          std::pow(std::max(towards_half, 0.0F), 900.0F)};
}

std::uint8_t to_byte(float light) {
  // Gamma 2.2 as its near relation, the square root.
  return static_cast<std::uint8_t>(std::sqrt(std::clamp(light, 0.0F, 1.0F)) * 255 + 0.5F);
}

Rgb lit(const Rgb& colour, const Shade& shade, float gloss) {
  const float mirror = gloss * shade.mirror;
  return {colour.r * colour.r * shade.diffuse + mirror,
          colour.g * colour.g * shade.diffuse + mirror,
          colour.b * colour.b * shade.diffuse + mirror};
}

} // namespace

ScopePicture::ScopePicture(const Phantom& phantom, int width, int height)
    : phantom_(phantom), width_(width), height_(height),
      mm_per_pixel_(phantom.picture_width_mm() / static_cast<float>(width)),
      still_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3) {
  draw_still();
}

ScopePicture::Place ScopePicture::place(int column, int row) const {
  return {(static_cast<float>(column) + 0.5F - static_cast<float>(width_) / 2) * mm_per_pixel_,
          (static_cast<float>(row) + 0.5F - static_cast<float>(height_) / 2) * mm_per_pixel_};
}

float ScopePicture::vignette(int column, int row) const {
  const float x = 2 * static_cast<float>(column) / static_cast<float>(width_) - 1;
  const float y = 2 * static_cast<float>(row) / static_cast<float>(height_) - 1;
  const float squared = (x * x + y * y) / 2;
  return 1 - 0.55F * squared * squared;
}

void ScopePicture::put(std::span<std::uint8_t> pixels, int column, int row,
                       const Rgb& light) const {
  const float dim = vignette(column, row);
  const auto at = (static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(column)) *
                  3;
  pixels[at] = to_byte(light.r * dim);
  pixels[at + 1] = to_byte(light.g * dim);
  pixels[at + 2] = to_byte(light.b * dim);
}

void ScopePicture::draw_still() {
  // Two rows of looks at a time: the slope is the step from the pixel to its left and above.
  std::vector<Look> above(static_cast<std::size_t>(width_) + 1);
  std::vector<Look> here(above.size());
  for (int row = -1; row < height_; ++row) {
    for (int column = -1; column < width_; ++column) {
      const Place at = place(column, row);
      here[static_cast<std::size_t>(column + 1)] = phantom_.look(at.x_mm, at.y_mm);
    }
    for (int column = 0; row >= 0 && column < width_; ++column) {
      const auto i = static_cast<std::size_t>(column) + 1;
      const Look& look = here[i];
      const Shade shade = shade_of((look.height_mm - here[i - 1].height_mm) / mm_per_pixel_,
                                   (look.height_mm - above[i].height_mm) / mm_per_pixel_);
      put(still_, column, row, lit(look.colour, shade, look.gloss));
    }
    above.swap(here);
  }
}

void ScopePicture::draw(double phase, std::span<std::uint8_t> pixels) const {
  std::ranges::copy(still_, pixels.begin());
  if (const Instrument* instrument = phantom_.instrument())
    draw_instrument(instrument->pose(phase), pixels);
}

void ScopePicture::draw_instrument(const Instrument::Pose& pose,
                                   std::span<std::uint8_t> pixels) const {
  constexpr Rgb steel{0.72F, 0.74F, 0.77F};
  constexpr float shadow_mm = 0.3F; // its shadow falls to the lower right
  const auto bounds = pose.bounds_mm();
  const auto pixel = [&](float mm, int size) {
    return static_cast<int>(std::clamp(mm / mm_per_pixel_ + static_cast<float>(size) / 2, 0.0F,
                                       static_cast<float>(size)));
  };
  for (int row = pixel(bounds[1], height_); row < pixel(bounds[3] + shadow_mm, height_); ++row) {
    for (int column = pixel(bounds[0], width_); column < pixel(bounds[2] + shadow_mm, width_);
         ++column) {
      const Place at = place(column, row);
      if (const auto top = pose.top_at(at.x_mm, at.y_mm)) {
        // Round bars: brightest along the middle, dark at the rims.
        const float shine = 0.25F + 0.75F * top->facing;
        const float streak = std::pow(top->facing, 24.0F);
        put(pixels, column, row,
            lit(mix(Rgb{0.2F, 0.21F, 0.23F}, steel, shine), {shine, 0.5F * streak}, 1));
      } else if (pose.top_at(at.x_mm - shadow_mm * 0.6F, at.y_mm - shadow_mm * 0.8F)) {
        const auto i = (static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(column)) *
                       3;
        for (std::uint8_t& value : pixels.subspan(i, 3))
          value = static_cast<std::uint8_t>(value * 5 / 8);
      }
    }
  }
}

PictureRectangle ScopePicture::field(double a_mm, double b_mm) const {
  const double mm = static_cast<double>(mm_per_pixel_);
  const double width = a_mm / (mm * width_);
  const double height = b_mm / (mm * height_);
  return {0.5 - width / 2, 0.5 - height / 2, width, height};
}

} // namespace octascope::sim
