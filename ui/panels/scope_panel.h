// The microscope's ambient-light picture.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/result.h"
#include "hal/scope_camera.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout.h"
#include "ui/scan_field.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates only when the picture's size changes.
class ScopePanel {
public:
  static hal::Result<ScopePanel> create();

  // Copies the frame before it returns.
  hal::Result<> show(const hal::ScopeFrame& frame, const std::optional<ScanField>& field);

  // The picture in `rect`; darker where it is old.
  void draw(const Rect& rect, int target_height, bool stale) const;

  bool empty() const { return !texture_; }
  double aspect() const { return static_cast<double>(width_) / height_; }
  hal::TimePoint time() const { return time_; }
  const std::optional<ScanField>& field() const { return field_; }

private:
  explicit ScopePanel(gl::PicturePass pass);

  gl::PicturePass pass_;
  gl::Texture texture_;
  std::vector<std::uint8_t> rgba_;
  int width_ = 4;
  int height_ = 3;
  hal::TimePoint time_;
  std::optional<ScanField> field_;
  struct {
    GLint picture, brightness;
  } uniforms_;
};

} // namespace octascope::ui
