#include "hal/linux/aravis/aravis_library.h"

#include <dlfcn.h>

namespace octascope::hal::linux_backend {

namespace {

tl::unexpected<Error> refuse() {
  return fail(ErrorCode::unsupported,
              "GenICam camera: Aravis cannot be loaded ({}), expected its library; install it with "
              "`apt install libaravis-0.8-0`, or name another camera in the configuration: "
              "[devices] line_camera",
              ::dlerror());
}

// GLib's functions are found, too: the libraries that a library needs are searched with it.
template <class Function> bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  return function != nullptr;
}

bool find_all(void* library, AravisLibrary& aravis) {
  return find(library, "arv_enable_interface", aravis.enable_interface) &&
         find(library, "arv_disable_interface", aravis.disable_interface) &&
         find(library, "arv_camera_new", aravis.camera_new) &&
         find(library, "arv_camera_get_device", aravis.camera_get_device) &&
         find(library, "arv_camera_get_vendor_name", aravis.camera_get_vendor_name) &&
         find(library, "arv_camera_get_model_name", aravis.camera_get_model_name) &&
         find(library, "arv_camera_get_device_serial_number",
              aravis.camera_get_device_serial_number) &&
         find(library, "arv_camera_dup_available_pixel_formats_as_strings",
              aravis.camera_dup_available_pixel_formats_as_strings) &&
         find(library, "arv_camera_set_pixel_format_from_string",
              aravis.camera_set_pixel_format_from_string) &&
         find(library, "arv_camera_get_pixel_format", aravis.camera_get_pixel_format) &&
         find(library, "arv_camera_set_region", aravis.camera_set_region) &&
         find(library, "arv_camera_get_region", aravis.camera_get_region) &&
         find(library, "arv_camera_get_width_bounds", aravis.camera_get_width_bounds) &&
         find(library, "arv_camera_get_height_bounds", aravis.camera_get_height_bounds) &&
         find(library, "arv_camera_get_payload", aravis.camera_get_payload) &&
         find(library, "arv_camera_is_feature_available", aravis.camera_is_feature_available) &&
         find(library, "arv_camera_set_float", aravis.camera_set_float) &&
         find(library, "arv_camera_set_trigger", aravis.camera_set_trigger) &&
         find(library, "arv_camera_is_exposure_auto_available",
              aravis.camera_is_exposure_auto_available) &&
         find(library, "arv_camera_set_exposure_time_auto", aravis.camera_set_exposure_time_auto) &&
         find(library, "arv_camera_get_exposure_time_bounds",
              aravis.camera_get_exposure_time_bounds) &&
         find(library, "arv_camera_get_exposure_time", aravis.camera_get_exposure_time) &&
         find(library, "arv_camera_set_exposure_time", aravis.camera_set_exposure_time) &&
         find(library, "arv_camera_is_gain_auto_available", aravis.camera_is_gain_auto_available) &&
         find(library, "arv_camera_set_gain_auto", aravis.camera_set_gain_auto) &&
         find(library, "arv_camera_get_gain_bounds", aravis.camera_get_gain_bounds) &&
         find(library, "arv_camera_get_gain", aravis.camera_get_gain) &&
         find(library, "arv_camera_set_gain", aravis.camera_set_gain) &&
         find(library, "arv_camera_set_acquisition_mode", aravis.camera_set_acquisition_mode) &&
         find(library, "arv_camera_gv_set_stream_options", aravis.camera_gv_set_stream_options) &&
         find(library, "arv_camera_create_stream", aravis.camera_create_stream) &&
         find(library, "arv_camera_start_acquisition", aravis.camera_start_acquisition) &&
         find(library, "arv_camera_stop_acquisition", aravis.camera_stop_acquisition) &&
         find(library, "arv_device_error_quark", aravis.device_error_quark) &&
         find(library, "arv_stream_push_buffer", aravis.stream_push_buffer) &&
         find(library, "arv_stream_try_pop_buffer", aravis.stream_try_pop_buffer) &&
         find(library, "arv_stream_timeout_pop_buffer", aravis.stream_timeout_pop_buffer) &&
         find(library, "arv_buffer_new_full", aravis.buffer_new_full) &&
         find(library, "arv_buffer_get_user_data", aravis.buffer_get_user_data) &&
         find(library, "arv_buffer_get_status", aravis.buffer_get_status) &&
         find(library, "arv_buffer_get_payload_type", aravis.buffer_get_payload_type) &&
         find(library, "arv_buffer_get_frame_id", aravis.buffer_get_frame_id) &&
         find(library, "arv_buffer_get_timestamp", aravis.buffer_get_timestamp) &&
         find(library, "arv_buffer_get_image_region", aravis.buffer_get_image_region) &&
         find(library, "arv_buffer_get_image_pixel_format", aravis.buffer_get_image_pixel_format) &&
         find(library, "g_object_ref", aravis.object_ref) &&
         find(library, "g_object_unref", aravis.object_unref) &&
         find(library, "g_object_set", aravis.object_set) &&
         find(library, "g_signal_connect_data", aravis.signal_connect_data) &&
         find(library, "g_error_free", aravis.error_free) && find(library, "g_free", aravis.free);
}

ErrorCode code_of(const GError& error, GQuark of_devices, ErrorCode gone) {
  if (error.domain != of_devices)
    return ErrorCode::unsupported; // of a feature that the camera does not have
  switch (error.code) {
  case ARV_DEVICE_ERROR_NOT_FOUND:
  case ARV_DEVICE_ERROR_NOT_CONNECTED:
  case ARV_DEVICE_ERROR_TRANSFER_ERROR:
  case ARV_DEVICE_ERROR_TIMEOUT:
  case ARV_DEVICE_ERROR_NO_STREAM_CHANNEL: return gone; // their number could not be read
  case ARV_DEVICE_ERROR_NOT_CONTROLLER:
  case ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED:
  case ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY: return ErrorCode::busy;
  case ARV_DEVICE_ERROR_WRONG_FEATURE:
  case ARV_DEVICE_ERROR_FEATURE_NOT_FOUND: return ErrorCode::unsupported;
  default: return ErrorCode::system;
  }
}

std::string_view remedy_for(ErrorCode code) {
  switch (code) {
  case ErrorCode::absent:
    return "check cable, power and the camera's name or address, and the service's drop-in "
           "(docs/DEVICES.md)";
  case ErrorCode::busy: return "end the other program that controls the camera";
  case ErrorCode::disconnected: return "check cable and power; it is opened again when it is back";
  case ErrorCode::unsupported: return "the camera has no such feature or value";
  default: return "switch the camera off and on";
  }
}

} // namespace

Result<AravisLibrary> AravisLibrary::load(const char* file) {
  void* const library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr)
    return refuse();
  AravisLibrary aravis;
  if (!find_all(library, aravis))
    return refuse();
  return aravis;
}

tl::unexpected<Error> AravisAnswer::error(std::string_view camera, std::string_view action,
                                          ErrorCode gone) const {
  const ErrorCode code =
      error_ != nullptr ? code_of(*error_, aravis_.device_error_quark(), gone) : ErrorCode::system;
  return fail(code, "{}: {} failed: {}; {}", camera, action,
              error_ != nullptr ? error_->message : "no reason given", remedy_for(code));
}

} // namespace octascope::hal::linux_backend
