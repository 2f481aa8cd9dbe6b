// What the microscope's camera sees of a phantom.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_instrument.h"

namespace octascope::sim {

// A rectangle as fractions of the picture's width and height; (0, 0) is its upper left corner.
struct PictureRectangle {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

// The view from above: x to the right, y down, the scan field's centre in the middle of the
// picture. Lit by a ring of lamps at the objective: soft shading from the surface's slope, mirror
// images of the lamps on glossy places, darker towards the corners.
class ScopePicture {
public:
  // Draws the static parts once: about 0.1 s at 640×480. Borrows the phantom.
  ScopePicture(const Phantom& phantom, int width, int height);

  std::size_t bytes() const { return still_.size(); }

  // The whole picture at a phase of the loop, rgb8, rows without gaps; `pixels` has bytes() bytes.
  void draw(double phase, std::span<std::uint8_t> pixels) const;

  // The place of a centred field of this size.
  PictureRectangle field(double a_mm, double b_mm) const;

private:
  struct Place {
    float x_mm;
    float y_mm;
  };
  Place place(int column, int row) const;
  float vignette(int column, int row) const;
  void draw_still();
  void draw_instrument(const Instrument::Pose& pose, std::span<std::uint8_t> pixels) const;
  void put(std::span<std::uint8_t> pixels, int column, int row, const Rgb& light) const;

  const Phantom& phantom_;
  int width_;
  int height_;
  float mm_per_pixel_;
  std::vector<std::uint8_t> still_;
};

} // namespace octascope::sim
