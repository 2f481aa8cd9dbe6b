// What surrounds the volume in pictures of the whole display.
#pragma once

#include <cstddef>
#include <vector>

#include "hal/scope_camera.h"
#include "pipeline/volume/volume.h"
#include "ui/layout/scan_field.h"
#include "ui/status/status.h"

namespace octascope::tests {

// A machine in good order, on its twins.
ui::Status live_status();

// Everything that can be said at once, as long as it gets.
ui::Status worst_status();

// Marks three B-scans around the twelfth as missing, with their voxels 0, and two as saturated.
void mark_incomplete(pipeline::Volume& volume);

// A made-up view through a microscope: an iris on white. Owns the pixels of its frames.
class ScopePicture {
public:
  ScopePicture(int width, int height);
  hal::ScopeFrame frame(hal::TimePoint time) const;
  ui::ScanField field() const;

private:
  int width_;
  int height_;
  std::vector<std::byte> rgb_;
};

} // namespace octascope::tests
