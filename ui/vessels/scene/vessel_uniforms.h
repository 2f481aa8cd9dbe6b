// What the shaders of all vessels have in common.
#pragma once

#include <string>

#include "ui/gl/program.h"
#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// Goes before every shader: precision and the constants of vessel_frame.h.
std::string vessel_shader_head();

// Makes the program current and sets those of its uniforms that depend on the frame.
void set_vessel_uniforms(const gl::Program& program, const VesselFrame& frame);

// Nearest first, opaque; puts back what the rest of the display expects: no depth test.
class VesselDrawState {
public:
  VesselDrawState();
  VesselDrawState(const VesselDrawState&) = delete;
  VesselDrawState& operator=(const VesselDrawState&) = delete;
  ~VesselDrawState();
};

} // namespace octascope::ui
