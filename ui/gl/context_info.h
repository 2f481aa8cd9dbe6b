// Describes the GL implementation, for `doctor` and reports.
#pragma once

#include <string>

namespace octascope::ui::gl {

struct ContextInfo {
  std::string renderer;  // "llvmpipe (LLVM 15.0.6, 256 bits)", "NVIDIA …"
  std::string version;   // "OpenGL ES 3.2 Mesa 22.3.6"
  bool software = false; // drawn by the CPU
};

// Of the context that is current on this thread.
ContextInfo describe_context();

} // namespace octascope::ui::gl
