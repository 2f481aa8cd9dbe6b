// What is built where Aravis's headers are missing: a camera that cannot be opened and says why.
#include "hal/linux/aravis/genicam_camera.h"

namespace octascope::hal::linux_backend {

namespace {

tl::unexpected<Error> refuse() {
  return fail(ErrorCode::unsupported,
              "GenICam camera: this octascope was built without Aravis; install it with `apt "
              "install libaravis-dev libusb-1.0-0-dev` and build octascope again, or name another "
              "camera in the configuration: [devices] line_camera");
}

class NoGenicamCamera final : public LineCamera {
public:
  explicit NoGenicamCamera(const GenicamAddress& address) : simulated_{address.simulated()} {}

private:
  std::string_view do_backend() const override { return "aravis"; }
  bool do_simulated() const override { return simulated_; }
  Result<> do_open(const LineCameraConfig& /*config*/) override { return refuse(); }
  Result<> do_start() override { return refuse(); }
  Result<std::optional<LineFrame>> do_wait_frame(Duration /*timeout*/) override { return refuse(); }
  void do_release(int /*buffer*/) override {}
  void do_stop() override {}
  void do_close() override {}
  std::string do_identity() const override { return {}; }

  const bool simulated_;
};

} // namespace

std::unique_ptr<LineCamera> make_genicam_camera(GenicamCameraOptions options, Clock& /*clock*/) {
  return std::make_unique<NoGenicamCamera>(options.address);
}

Result<GenicamFinding> find_genicam_camera(const GenicamAddress& /*address*/) {
  return refuse();
}

} // namespace octascope::hal::linux_backend
