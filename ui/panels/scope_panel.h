// The microscope's ambient-light picture.
#pragma once

#include <optional>

#include "hal/result.h"
#include "hal/scope_camera.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout/layout.h"
#include "ui/layout/scan_field.h"
#include "ui/panels/scope_texture.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class ScopePanel {
public:
  static hal::Result<ScopePanel> create();

  // Copies the frame before it returns.
  hal::Result<> show(const hal::ScopeFrame& frame, const std::optional<ScanField>& field);

  // Draws the picture into `rect`, darkened if stale.
  void draw(const Rect& rect, int target_height, bool stale) const;

  bool empty() const { return !picture_.texture(); }
  double aspect() const { return static_cast<double>(picture_.width()) / picture_.height(); }
  hal::TimePoint time() const { return time_; }
  const std::optional<ScanField>& field() const { return field_; }

private:
  ScopePanel(gl::PicturePass pass, ScopeTexture picture);

  gl::PicturePass pass_;
  ScopeTexture picture_;
  hal::TimePoint time_;
  std::optional<ScanField> field_;
  struct {
    GLint picture, brightness;
  } uniforms_;
};

} // namespace octascope::ui
