// A camera's motion JPEG, whole or not, into a picture of a fixed size; and the decoder still
// decodes.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/linux/libcamera/motion_jpeg.h"
#include "tests/fuzz/expect.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace octascope;
  using namespace octascope::hal::linux_backend;
  auto decoder = MotionJpegDecoder::make();
  tests::expect(decoder.has_value(), "a decoder can be made");
  constexpr PictureSize picture{64, 48};
  std::vector<std::byte> rgb(3 * 64 * 48);
  const std::span<const std::byte> jpeg{reinterpret_cast<const std::byte*>(bytes), size};
  for (int twice = 0; twice < 2; ++twice) {
    const auto decoded = decoder->decode(jpeg, picture, rgb);
    tests::expect(decoded || !decoded.error().message.empty(), "a refusal has words");
  }
  return 0;
}
