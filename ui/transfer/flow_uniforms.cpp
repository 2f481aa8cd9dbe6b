#include "ui/transfer/flow_uniforms.h"

#include "ui/transfer/flow_look.h"

namespace octascope::ui {

void set_flow_look(const gl::Program& program) {
  const auto set = [&](const char* name, const TransferTable::Colour& colour) {
    glUniform3f(program.uniform(name), colour.red, colour.green, colour.blue);
  };
  glUniform2f(program.uniform("u_flow_seen"), flow_seen_from, flow_seen_full);
  set("u_flow_wall", flow_wall);
  set("u_flow_middle", flow_middle);
}

} // namespace octascope::ui
