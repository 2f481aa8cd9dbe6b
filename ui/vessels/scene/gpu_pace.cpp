#include "ui/vessels/scene/gpu_pace.h"

#include "ui/gl/context_info.h"

namespace octascope::ui {

namespace {
constexpr std::uint32_t portion = 16;               // batches between two fences
constexpr GLuint64 longest_wait_ns = 1'000'000'000; // a GPU that hangs is not ours to fix
} // namespace

GpuPace::GpuPace() : paced_{!gl::describe_context().software} {}

GpuPace::~GpuPace() {
  for (const GLsync fence : fences_)
    glDeleteSync(fence); // ignores null
}

void GpuPace::submitted() {
  if (!paced_ || ++batches_ % portion != 0)
    return;
  GLsync& fence = fences_[next_];
  next_ = (next_ + 1) % fences_.size();
  if (fence != nullptr) {
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, longest_wait_ns);
    glDeleteSync(fence);
  }
  fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

} // namespace octascope::ui
