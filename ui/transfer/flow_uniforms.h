// Sets what ui/shaders/flow_look.glsl reads.
#pragma once

#include "ui/gl/program.h"

namespace octascope::ui {

// Of the program in use.
void set_flow_look(const gl::Program& program);

} // namespace octascope::ui
