// Drawing allocates nothing of ours once it runs. Counts operator new, which the C code of the
// driver does not use; sanitizers bring an operator new of their own, so not under them.
#ifndef OCTASCOPE_SANITIZED

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/scene.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/renderer.h"

namespace {
thread_local std::size_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size))
    return memory;
  throw std::bad_alloc{};
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace octascope::tests {
namespace {

class Allocation : public GlTest {};

TEST_F(Allocation, a_running_display_makes_none) {
  auto renderer = ui::Renderer::create();
  ASSERT_TRUE(renderer) << renderer.error().message;
  const auto volume = tissue_volume(small_geometry);
  const ScopePicture scope{64, 48};
  ui::Status status = live_status();
  status.notice = "A notice that is longer than any small string";
  ui::ViewState view;
  const auto one_frame = [&](int i) {
    view.yaw_deg = static_cast<float>(7 * i);
    view.b_scan = i % 40;
    view.echo_until = status.now + std::chrono::seconds{1};
    status.frames_per_s = i;
    status.freshness = {
        i % 2 == 0 ? ui::Liveness::live : ui::Liveness::stale, std::chrono::seconds{i}, {}};
    EXPECT_TRUE((*renderer)->show_volume(volume));
    EXPECT_TRUE((*renderer)->show_scope_picture(scope.frame(status.now), scope.field()));
    EXPECT_TRUE((*renderer)->needs_redraw(view, status, 640, 360));
    EXPECT_TRUE((*renderer)->draw(view, status, 640, 360));
    EXPECT_TRUE(display_.present());
  };
  for (int i = 0; i < 6; ++i)
    one_frame(i);
  const std::size_t before = allocations;
  for (int i = 6; i < 16; ++i)
    one_frame(i);
  EXPECT_EQ(allocations - before, 0U);
}

} // namespace
} // namespace octascope::tests

#endif
