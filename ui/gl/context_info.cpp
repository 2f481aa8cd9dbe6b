#include "ui/gl/context_info.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <GLES3/gl3.h>

namespace octascope::ui::gl {

namespace {

std::string text_of(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? "unknown" : reinterpret_cast<const char*>(text);
}

} // namespace

ContextInfo describe_context() {
  constexpr std::array<std::string_view, 3> software_renderers{"llvmpipe", "softpipe", "swrast"};
  ContextInfo info{text_of(GL_RENDERER), text_of(GL_VERSION), false};
  info.software = std::ranges::any_of(software_renderers, [&](std::string_view name) {
    return info.renderer.find(name) != std::string::npos;
  });
  return info;
}

} // namespace octascope::ui::gl
