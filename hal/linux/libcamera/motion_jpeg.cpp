#include "hal/linux/libcamera/motion_jpeg.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <turbojpeg.h>

namespace octascope::hal::linux_backend {

Result<MotionJpegDecoder> MotionJpegDecoder::make() {
  void* const handle = tjInitDecompress();
  if (handle == nullptr)
    return fail(ErrorCode::system,
                "scope camera: no memory for the JPEG decoder; end other programs");
  return MotionJpegDecoder{handle};
}

MotionJpegDecoder::MotionJpegDecoder(MotionJpegDecoder&& other) noexcept
    : handle_{std::exchange(other.handle_, nullptr)} {}

MotionJpegDecoder& MotionJpegDecoder::operator=(MotionJpegDecoder&& other) noexcept {
  std::swap(handle_, other.handle_);
  return *this;
}

MotionJpegDecoder::~MotionJpegDecoder() {
  if (handle_ != nullptr)
    tjDestroy(handle_);
}

Result<> MotionJpegDecoder::decode(std::span<const std::byte> jpeg, PictureSize size,
                                   std::span<std::byte> rgb) {
  auto decoded = try_to_decode(jpeg, size, rgb);
  if (!decoded) {
    // A damaged header can leave libjpeg-turbo 2.1 in a state in which it refuses good pictures
    // ever after ("SOS before SOF").
    if (handle_ != nullptr)
      tjDestroy(handle_);
    handle_ = tjInitDecompress();
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
  if (tjDecompressHeader3(handle_, bytes, jpeg.size(), &width, &height, &subsampling, &colours) !=
      0)
    return fail(ErrorCode::bad_data,
                fmt::format("scope camera: a JPEG of {} bytes has no header: {}", jpeg.size(),
                            tjGetErrorStr2(handle_)));
  if (width != size.width || height != size.height ||
      rgb.size() < static_cast<std::size_t>(3 * width) * static_cast<std::size_t>(height))
    return fail(ErrorCode::bad_data, fmt::format("scope camera: a JPEG of {}x{}, expected {}x{}",
                                                 width, height, size.width, size.height));
  if (tjDecompress2(handle_, bytes, jpeg.size(), reinterpret_cast<unsigned char*>(rgb.data()),
                    width, 3 * width, height, TJPF_RGB, 0) == 0)
    return {};
  const std::string_view why = tjGetErrorStr2(handle_);
  if (tjGetErrorCode(handle_) == TJERR_WARNING &&
      why.find("extraneous bytes") != std::string_view::npos)
    return {};
  return fail(ErrorCode::bad_data,
              fmt::format("scope camera: a damaged JPEG of {} bytes: {}", jpeg.size(), why));
}

} // namespace octascope::hal::linux_backend
