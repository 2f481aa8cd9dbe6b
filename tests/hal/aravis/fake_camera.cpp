#include "tests/hal/aravis/fake_camera.h"

#include <chrono>
#include <cstring>
#include <utility>

#include <arv.h>

namespace octascope::tests {

using namespace std::chrono_literals;

namespace {

// Registers of arvfakecamera.h.
constexpr guint32 frame_period_us = ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US;
constexpr guint32 trigger_software = ARV_FAKE_CAMERA_REGISTER_TRIGGER_SOFTWARE;

ArvFakeCamera* registers_of(void* camera) {
  return arv_gv_fake_camera_get_fake_camera(static_cast<ArvGvFakeCamera*>(camera));
}

void fill(ArvBuffer* buffer, void* frame, guint32 /*exposure_us*/, guint32 /*gain*/,
          ArvPixelFormat /*format*/) {
  const auto& bytes = *static_cast<const std::vector<std::byte>*>(frame);
  // Its size is not set before it is full.
  void* const into = const_cast<void*>(arv_buffer_get_data(buffer, nullptr));
  std::memcpy(into, bytes.data(), bytes.size());
}

} // namespace

FakeCamera::FakeCamera(FakeCameraTraits traits) : traits_{std::move(traits)} {
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
  camera_ =
      g_object_new(arv_gv_fake_camera_get_type(), "interface-name", address, "serial-number",
                   "OCT1", "gvsp-lost-ratio", traits_.lost, "genicam-filename",
                   traits_.description.empty() ? nullptr : traits_.description.c_str(), nullptr);
  // As soon as it can after a trigger.
  arv_fake_camera_write_register(registers_of(camera_), frame_period_us, 1000);
}

std::string FakeCamera::usual_description() {
  ArvFakeCamera* const camera = arv_fake_camera_new("OCT1");
  std::size_t size = 0;
  const char* const text = arv_fake_camera_get_genicam_xml(camera, &size);
  std::string description{text, size};
  g_object_unref(camera);
  return description;
}

void FakeCamera::send_bytes(std::vector<std::byte> frame) {
  frame_ = std::move(frame);
  arv_fake_camera_set_fill_pattern(registers_of(camera_), &fill, &frame_);
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
