// Code and uniforms shared by all vessel shaders.
#pragma once

#include <string>

#include "ui/gl/program.h"
#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// Prepended to every shader: precision and the constants of vessel_frame.h.
std::string vessel_shader_head();

// Makes the program current and sets those of its uniforms that depend on the frame.
void set_vessel_uniforms(const gl::Program& program, const VesselFrame& frame);

// Nearest first, opaque; the destructor restores what the rest of the display expects: no depth
// test.
class VesselDrawState {
public:
  VesselDrawState();
  VesselDrawState(const VesselDrawState&) = delete;
  VesselDrawState& operator=(const VesselDrawState&) = delete;
  ~VesselDrawState();
};

} // namespace octascope::ui
