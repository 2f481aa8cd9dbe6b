#include "hal/linux/aravis/camera_features.h"

#include <fmt/format.h>

#include "hal/linux/aravis/genicam_pixels.h"

namespace octascope::hal::linux_backend {

namespace {

// The names of one feature, SFNC's first.
constexpr const char* line_rate_names[] = {"AcquisitionLineRate", "AcquisitionLineRateAbs"};

// Of the camera that is being opened.
class Settings {
public:
  Settings(const AravisLibrary& aravis, ArvCamera* camera, std::string name)
      : aravis_{aravis}, camera_{camera}, name_{std::move(name)}, answer_{aravis} {}

  Result<GenicamFormat> set_pixel_format(const LineFormat& wanted, Depths depths) {
    HAL_TRY(const auto offered, offered_formats(aravis_, camera_, name_));
    HAL_TRY(const auto chosen, choose_genicam_format(offered, wanted, depths));
    const std::string name{chosen.name};
    aravis_.camera_set_pixel_format_from_string(camera_, name.c_str(), answer_.out());
    HAL_CHECK(done("setting the pixel format"));
    return chosen;
  }

  Result<> set_size(const LineFormat& wanted) {
    HAL_CHECK(within("samples_per_line", wanted.samples_per_line, aravis_.camera_get_width_bounds));
    HAL_CHECK(within("lines_per_frame", wanted.lines_per_frame, aravis_.camera_get_height_bounds));
    constexpr int unchanged = -1; // the window's place on the sensor
    aravis_.camera_set_region(camera_, unchanged, unchanged, wanted.samples_per_line,
                              wanted.lines_per_frame, answer_.out());
    HAL_CHECK(done("setting the size"));
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    aravis_.camera_get_region(camera_, &x, &y, &width, &height, answer_.out());
    HAL_CHECK(done("reading the size"));
    if (width != wanted.samples_per_line || height != wanted.lines_per_frame)
      return fail(ErrorCode::unsupported, "{}: the camera gives {}×{}, expected {}×{}", name_,
                  width, height, wanted.samples_per_line, wanted.lines_per_frame);
    return {};
  }

  Result<> set_exposure(double exposure_us) {
    if (aravis_.camera_is_exposure_auto_available(camera_, answer_.out()) != 0)
      aravis_.camera_set_exposure_time_auto(camera_, ARV_AUTO_OFF, answer_.out());
    HAL_CHECK(done("ending automatic exposure"));
    HAL_CHECK(within("exposure_us", exposure_us, aravis_.camera_get_exposure_time_bounds));
    aravis_.camera_set_exposure_time(camera_, exposure_us, answer_.out());
    return done("setting the exposure");
  }

  Result<> set_gain(double gain) {
    if (aravis_.camera_is_gain_auto_available(camera_, answer_.out()) != 0)
      aravis_.camera_set_gain_auto(camera_, ARV_AUTO_OFF, answer_.out());
    HAL_CHECK(done("ending automatic gain"));
    HAL_CHECK(within("gain", gain, aravis_.camera_get_gain_bounds));
    aravis_.camera_set_gain(camera_, gain, answer_.out());
    return done("setting the gain");
  }

  Result<> set_trigger(const std::string& source) {
    aravis_.camera_set_trigger(camera_, source.c_str(), answer_.out());
    return done(fmt::format("setting the trigger to \"{}\"", source));
  }

  Result<> set_line_rate(double line_rate_hz) {
    for (const char* name : line_rate_names) {
      if (aravis_.camera_is_feature_available(camera_, name, answer_.out()) == 0)
        continue;
      aravis_.camera_set_float(camera_, name, line_rate_hz, answer_.out());
      return done("setting the line rate");
    }
    return {};
  }

  Result<CameraStream> stream(const LineFormat& wanted, const GenicamFormat& chosen) {
    aravis_.camera_set_acquisition_mode(camera_, ARV_ACQUISITION_MODE_CONTINUOUS, answer_.out());
    HAL_CHECK(done("setting the acquisition mode"));
    CameraStream stream;
    stream.packing = chosen.packing;
    stream.bits = chosen.bits;
    stream.pixel_format = aravis_.camera_get_pixel_format(camera_, answer_.out());
    HAL_CHECK(done("reading the pixel format"));
    stream.payload_bytes = aravis_.camera_get_payload(camera_, answer_.out());
    HAL_CHECK(done("reading the payload size"));
    const std::size_t samples = wanted.frame_bytes() / bytes_per_sample(wanted.sample_type);
    const std::size_t expected = chosen.packing == Packing::none
                                     ? wanted.frame_bytes()
                                     : packed_bytes(chosen.packing, samples);
    if (stream.payload_bytes < expected || stream.payload_bytes > 2 * expected + 65536)
      return fail(ErrorCode::unsupported, "{}: a frame has {} bytes, expected {}", name_,
                  stream.payload_bytes, expected);
    return stream;
  }

private:
  Result<> done(std::string_view action) {
    if (answer_.failed())
      return answer_.error(name_, action, ErrorCode::absent);
    return {};
  }

  template <class Number, class Bounds>
  Result<> within(std::string_view what, Number wanted, Bounds bounds) {
    Number least{};
    Number most{};
    bounds(camera_, &least, &most, answer_.out());
    HAL_CHECK(done(fmt::format("reading the range of {}", what)));
    if (wanted < least || wanted > most)
      return fail(ErrorCode::invalid_argument, "{}: {} is {}, expected {} to {}", name_, what,
                  wanted, least, most);
    return {};
  }

  const AravisLibrary& aravis_;
  ArvCamera* camera_;
  std::string name_;
  AravisAnswer answer_;
};

// Nothing where the camera has no such feature.
template <class Get, class Bounds>
std::optional<CameraControl> read_control(const AravisLibrary& aravis, ArvCamera* camera, Get get,
                                          Bounds bounds) {
  AravisAnswer answer{aravis};
  CameraControl control;
  control.value = get(camera, answer.out());
  if (answer.failed())
    return std::nullopt;
  bounds(camera, &control.least, &control.most, answer.out());
  if (answer.failed() || !(control.least <= control.most))
    return std::nullopt;
  return control;
}

// Aravis keeps one list of buses for the whole process.
void ask_only(const AravisLibrary& aravis, GenicamAddress::Bus bus) {
  const bool usb = bus == GenicamAddress::Bus::usb3_vision;
  aravis.disable_interface("Fake");
  aravis.disable_interface(usb ? "GigEVision" : "USB3Vision");
  aravis.enable_interface(usb ? "USB3Vision" : "GigEVision");
}

} // namespace

Result<Reference<ArvCamera>> open_camera(const AravisLibrary& aravis,
                                         const GenicamAddress& address) {
  ask_only(aravis, address.bus);
  AravisAnswer answer{aravis};
  const char* name = address.name.empty() ? nullptr : address.name.c_str();
  auto camera = own(aravis, aravis.camera_new(name, answer.out()));
  if (answer.failed())
    return answer.error(to_text(address), "opening", ErrorCode::absent);
  if (!camera)
    return fail(ErrorCode::absent, "{}: no camera is plugged in; check cable and power",
                to_text(address));
  if (address.bus == GenicamAddress::Bus::gige_vision) // a raw socket would need a privilege
    aravis.camera_gv_set_stream_options(camera.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  return camera;
}

std::string identity_of(const AravisLibrary& aravis, ArvCamera* camera) {
  AravisAnswer answer{aravis};
  std::string text;
  for (const auto ask : {aravis.camera_get_vendor_name, aravis.camera_get_model_name,
                         aravis.camera_get_device_serial_number}) {
    const char* part = ask(camera, answer.out());
    if (!answer.failed() && part != nullptr && *part != '\0')
      text += fmt::format("{}{}", text.empty() ? "" : " ", part);
  }
  return text;
}

Result<std::vector<std::string>> offered_formats(const AravisLibrary& aravis, ArvCamera* camera,
                                                 const std::string& name) {
  AravisAnswer answer{aravis};
  guint count = 0;
  const char** const texts =
      aravis.camera_dup_available_pixel_formats_as_strings(camera, &count, answer.out());
  if (answer.failed())
    return answer.error(name, "reading the pixel formats", ErrorCode::absent);
  std::vector<std::string> formats{texts, texts + count};
  aravis.free(texts); // the texts are the camera's
  return formats;
}

CameraControls controls_of(const AravisLibrary& aravis, ArvCamera* camera) {
  return {.exposure_us = read_control(aravis, camera, aravis.camera_get_exposure_time,
                                      aravis.camera_get_exposure_time_bounds),
          .gain =
              read_control(aravis, camera, aravis.camera_get_gain, aravis.camera_get_gain_bounds)};
}

Result<CameraStream> set_features(const AravisLibrary& aravis, ArvCamera* camera,
                                  const GenicamCameraOptions& options,
                                  const LineCameraConfig& config) {
  Settings settings{aravis, camera, to_text(options.address)};
  HAL_TRY(const GenicamFormat chosen, settings.set_pixel_format(config.format, options.depths));
  HAL_CHECK(settings.set_size(config.format));
  HAL_CHECK(settings.set_line_rate(config.line_rate_hz));
  if (options.exposure_us) {
    HAL_CHECK(settings.set_exposure(*options.exposure_us));
  }
  if (options.gain) {
    HAL_CHECK(settings.set_gain(*options.gain));
  }
  if (!options.trigger.empty()) {
    HAL_CHECK(settings.set_trigger(options.trigger));
  }
  return settings.stream(config.format, chosen);
}

} // namespace octascope::hal::linux_backend
