// Aravis's functions, loaded only when a configuration names a GenICam camera: nobody else needs
// it, nor the USB, network and XML libraries that it brings.
#pragma once

#include <memory>
#include <string_view>

#include <arv.h>

#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Copyable: the library stays loaded until the program ends, as GObject's types cannot be unloaded.
// Threads: as for Aravis; which of a camera's calls may run at once says camera_features.h.
struct AravisLibrary {
  // ErrorCode::unsupported: `file` is not installed or is not Aravis 0.8.
  static Result<AravisLibrary> load(const char* file = "libaravis-0.8.so.0");

  decltype(&arv_enable_interface) enable_interface = nullptr;
  decltype(&arv_disable_interface) disable_interface = nullptr;

  decltype(&arv_camera_new) camera_new = nullptr;
  decltype(&arv_camera_get_device) camera_get_device = nullptr;
  decltype(&arv_camera_get_vendor_name) camera_get_vendor_name = nullptr;
  decltype(&arv_camera_get_model_name) camera_get_model_name = nullptr;
  decltype(&arv_camera_get_device_serial_number) camera_get_device_serial_number = nullptr;
  decltype(&arv_camera_dup_available_pixel_formats_as_strings)
      camera_dup_available_pixel_formats_as_strings = nullptr;
  decltype(&arv_camera_set_pixel_format_from_string) camera_set_pixel_format_from_string = nullptr;
  decltype(&arv_camera_get_pixel_format) camera_get_pixel_format = nullptr;
  decltype(&arv_camera_set_region) camera_set_region = nullptr;
  decltype(&arv_camera_get_region) camera_get_region = nullptr;
  decltype(&arv_camera_get_width_bounds) camera_get_width_bounds = nullptr;
  decltype(&arv_camera_get_height_bounds) camera_get_height_bounds = nullptr;
  decltype(&arv_camera_get_payload) camera_get_payload = nullptr;
  decltype(&arv_camera_is_feature_available) camera_is_feature_available = nullptr;
  decltype(&arv_camera_set_float) camera_set_float = nullptr;
  decltype(&arv_camera_set_trigger) camera_set_trigger = nullptr;
  decltype(&arv_camera_is_exposure_auto_available) camera_is_exposure_auto_available = nullptr;
  decltype(&arv_camera_set_exposure_time_auto) camera_set_exposure_time_auto = nullptr;
  decltype(&arv_camera_get_exposure_time_bounds) camera_get_exposure_time_bounds = nullptr;
  decltype(&arv_camera_get_exposure_time) camera_get_exposure_time = nullptr;
  decltype(&arv_camera_set_exposure_time) camera_set_exposure_time = nullptr;
  decltype(&arv_camera_is_gain_auto_available) camera_is_gain_auto_available = nullptr;
  decltype(&arv_camera_set_gain_auto) camera_set_gain_auto = nullptr;
  decltype(&arv_camera_get_gain_bounds) camera_get_gain_bounds = nullptr;
  decltype(&arv_camera_get_gain) camera_get_gain = nullptr;
  decltype(&arv_camera_set_gain) camera_set_gain = nullptr;
  decltype(&arv_camera_set_acquisition_mode) camera_set_acquisition_mode = nullptr;
  decltype(&arv_camera_gv_set_stream_options) camera_gv_set_stream_options = nullptr;
  decltype(&arv_camera_create_stream) camera_create_stream = nullptr;
  decltype(&arv_camera_start_acquisition) camera_start_acquisition = nullptr;
  decltype(&arv_camera_stop_acquisition) camera_stop_acquisition = nullptr;
  decltype(&arv_device_error_quark) device_error_quark = nullptr;

  decltype(&arv_stream_push_buffer) stream_push_buffer = nullptr;
  decltype(&arv_stream_try_pop_buffer) stream_try_pop_buffer = nullptr;
  decltype(&arv_stream_timeout_pop_buffer) stream_timeout_pop_buffer = nullptr;

  decltype(&arv_buffer_new_full) buffer_new_full = nullptr;
  decltype(&arv_buffer_get_user_data) buffer_get_user_data = nullptr;
  decltype(&arv_buffer_get_status) buffer_get_status = nullptr;
  decltype(&arv_buffer_get_payload_type) buffer_get_payload_type = nullptr;
  decltype(&arv_buffer_get_frame_id) buffer_get_frame_id = nullptr;
  decltype(&arv_buffer_get_timestamp) buffer_get_timestamp = nullptr;
  decltype(&arv_buffer_get_image_region) buffer_get_image_region = nullptr;
  decltype(&arv_buffer_get_image_pixel_format) buffer_get_image_pixel_format = nullptr;

  // Of GLib, on which it stands.
  decltype(&g_object_ref) object_ref = nullptr;
  decltype(&g_object_unref) object_unref = nullptr;
  decltype(&g_object_set) object_set = nullptr;
  decltype(&g_signal_connect_data) signal_connect_data = nullptr;
  decltype(&g_error_free) error_free = nullptr;
  decltype(&g_free) free = nullptr;
};

// A GObject with one reference of ours.
template <class Object> struct Unreference {
  decltype(&g_object_unref) unreference = nullptr;
  void operator()(Object* object) const { unreference(object); }
};
template <class Object> using Reference = std::unique_ptr<Object, Unreference<Object>>;

template <class Object> Reference<Object> own(const AravisLibrary& aravis, Object* object) {
  return {object, {aravis.object_unref}};
}

// What the last calls of Aravis answered. One for a sequence of calls that stops at the first
// error: pass out() to each, ask failed() after it.
class AravisAnswer {
public:
  explicit AravisAnswer(const AravisLibrary& aravis) : aravis_{aravis} {}
  ~AravisAnswer() { forget(); }
  AravisAnswer(const AravisAnswer&) = delete;
  AravisAnswer& operator=(const AravisAnswer&) = delete;

  // For one call; an error of the one before is forgotten.
  GError** out() {
    forget();
    return &error_;
  }
  bool failed() const { return error_ != nullptr; }

  // After a failure. A camera that does not answer is `gone`: absent while it is opened,
  // disconnected later.
  tl::unexpected<Error> error(std::string_view camera, std::string_view action,
                              ErrorCode gone) const;

private:
  void forget() {
    if (error_ != nullptr)
      aravis_.error_free(error_);
    error_ = nullptr;
  }

  const AravisLibrary& aravis_;
  GError* error_ = nullptr;
};

} // namespace octascope::hal::linux_backend
