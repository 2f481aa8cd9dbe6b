// The live spectrum over the whole screen, while an instrument is being aligned.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hal/result.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_renderer.h"

namespace octascope::ui {

// One row beside the curve.
struct SpectrumFigure {
  std::string name;
  std::string value;       // with its unit
  std::string good;        // what it should be
  std::string remedy = {}; // what helps; empty: it is good
};

// Lines in counts over the camera's pixels, of one length. Borrowed while it is drawn.
struct LiveSpectrum {
  std::span<const double> mean;
  std::span<const double> last;
  std::span<const double> highest; // of all lines: where it reaches full scale is marked
  double full_scale = 1;           // counts
  double dark = 0;                 // counts
  std::span<const SpectrumFigure> figures;
};

// Onto a canvas that was begun for this size; `unit` as in Layout. The spectrum has a pixel at least.
void lay_out_spectrum(Canvas& canvas, int width, int height, float unit,
                      const LiveSpectrum& spectrum);

// Threads: as gl/objects.h.
class SpectrumScreen {
public:
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<SpectrumScreen> create(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Over the whole bound framebuffer, of the size that it was created for.
  void draw(const LiveSpectrum& spectrum);

private:
  SpectrumScreen(int width, int height, Fonts fonts, CanvasRenderer renderer);

  int width_;
  int height_;
  Fonts fonts_;
  CanvasRenderer renderer_;
};

} // namespace octascope::ui
