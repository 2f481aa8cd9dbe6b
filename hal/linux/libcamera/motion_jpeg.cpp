#include "hal/linux/libcamera/motion_jpeg.h"

#include <string_view>

#include <turbojpeg.h>

namespace octascope::hal::linux_backend {

Result<MotionJpegDecoder> MotionJpegDecoder::make() {
  void* const handle = tjInitDecompress();
  if (handle == nullptr)
    return fail(ErrorCode::system,
                "scope camera: no memory for the JPEG decoder; end other programs");
  return MotionJpegDecoder{handle};
}

void MotionJpegDecoder::Destroy::operator()(void* handle) const {
  tjDestroy(handle);
}

Result<> MotionJpegDecoder::decode(std::span<const std::byte> jpeg, PictureSize size,
                                   std::span<std::byte> rgb) {
  auto decoded = try_to_decode(jpeg, size, rgb);
  if (!decoded) {
    // A damaged header can leave libjpeg-turbo 2.1 in a state in which it refuses good pictures
    // ever after ("SOS before SOF").
    handle_.reset();
    handle_.reset(tjInitDecompress());
  }
  return decoded;
}

Result<> MotionJpegDecoder::try_to_decode(std::span<const std::byte> jpeg, PictureSize size,
                                          std::span<std::byte> rgb) {
  if (handle_ == nullptr)
    return fail(ErrorCode::system,
                "scope camera: no memory for the JPEG decoder; end other programs");
  const auto* const bytes = reinterpret_cast<const unsigned char*>(jpeg.data());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colours = 0;
  if (tjDecompressHeader3(handle_.get(), bytes, jpeg.size(), &width, &height, &subsampling,
                          &colours) != 0)
    return fail(ErrorCode::bad_data, "scope camera: a JPEG of {} bytes has no header: {}",
                jpeg.size(), tjGetErrorStr2(handle_.get()));
  if (width != size.width || height != size.height ||
      rgb.size() < static_cast<std::size_t>(3 * width) * static_cast<std::size_t>(height))
    return fail(ErrorCode::bad_data, "scope camera: a JPEG of {}x{}, expected {}x{}", width, height,
                size.width, size.height);
  if (tjDecompress2(handle_.get(), bytes, jpeg.size(), reinterpret_cast<unsigned char*>(rgb.data()),
                    width, 3 * width, height, TJPF_RGB, 0) == 0)
    return {};
  const std::string_view why = tjGetErrorStr2(handle_.get());
  if (tjGetErrorCode(handle_.get()) == TJERR_WARNING &&
      why.find("extraneous bytes") != std::string_view::npos)
    return {};
  return fail(ErrorCode::bad_data, "scope camera: a damaged JPEG of {} bytes: {}", jpeg.size(),
              why);
}

} // namespace octascope::hal::linux_backend
