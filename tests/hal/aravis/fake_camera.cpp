#include "tests/hal/aravis/fake_camera.h"

#include <chrono>

#include <arv.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace octascope::tests {

using namespace std::chrono_literals;

namespace {

// Registers of arvfakecamera.h.
constexpr guint32 frame_period_us = ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US;
constexpr guint32 trigger_software = ARV_FAKE_CAMERA_REGISTER_TRIGGER_SOFTWARE;

ArvFakeCamera* registers_of(void* camera) {
  return arv_gv_fake_camera_get_fake_camera(static_cast<ArvGvFakeCamera*>(camera));
}

} // namespace

// Tests run beside each other, in processes of their own.
struct FakeCamera::Port {
  Port() : file{::open("/tmp/octascope-fake-camera.lock", O_CREAT | O_RDWR | O_CLOEXEC, 0666)} {
    ::flock(file, LOCK_EX);
  }
  ~Port() { ::close(file); }
  int file;
};

FakeCamera::FakeCamera(double lost) : lost_{lost}, port_{std::make_unique<Port>()} {
  plug_in();
}

FakeCamera::~FakeCamera() {
  unplug();
}

bool FakeCamera::runs() const {
  return camera_ != nullptr &&
         arv_gv_fake_camera_is_running(static_cast<ArvGvFakeCamera*>(camera_)) != 0;
}

void FakeCamera::plug_in() {
  camera_ = g_object_new(arv_gv_fake_camera_get_type(), "interface-name", address, "serial-number",
                         "OCT1", "gvsp-lost-ratio", lost_, nullptr);
  // As soon as it can after a trigger.
  arv_fake_camera_write_register(registers_of(camera_), frame_period_us, 1000);
}

void FakeCamera::trigger(int frames) {
  if (sending_.joinable())
    sending_.join();
  sending_ = std::thread{[this, frames] { send(frames); }};
}

void FakeCamera::send(int frames) {
  ArvFakeCamera* const registers = registers_of(camera_);
  for (int i = 0; i < frames; ++i) {
    arv_fake_camera_write_register(registers, trigger_software, 1);
    guint32 waits = 1;
    while (waits != 0 && !over_) {
      std::this_thread::sleep_for(1ms);
      arv_fake_camera_read_register(registers, trigger_software, &waits);
    }
  }
}

void FakeCamera::unplug() {
  over_ = true;
  if (sending_.joinable())
    sending_.join();
  over_ = false;
  if (camera_ != nullptr)
    g_object_unref(camera_);
  camera_ = nullptr;
}

void FakeCamera::replug() {
  plug_in();
}

} // namespace octascope::tests
