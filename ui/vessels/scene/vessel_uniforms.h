// What all vessel shaders have in common.
#pragma once

#include <string>

#include "ui/gl/program.h"
#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// The common prefix of all shaders: precision and the constants of vessel_frame.h.
std::string vessel_shader_head();

// Makes the program current and sets its uniforms that depend on the frame.
void set_vessel_uniforms(const gl::Program& program, const VesselFrame& frame);

// GL state for drawing opaque vessels, nearest in front; the destructor restores the display's
// default (no depth test).
class VesselDrawState {
public:
  VesselDrawState();
  VesselDrawState(const VesselDrawState&) = delete;
  VesselDrawState& operator=(const VesselDrawState&) = delete;
  ~VesselDrawState();
};

} // namespace octascope::ui
