// A driver may offer and give whatever it likes: a request that it offered, or words.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "hal/linux/v4l2/format_negotiation.h"
#include "tests/fuzz/expect.h"

namespace {

using namespace octascope;
using namespace octascope::hal::linux_backend;

// Numbers off the input, 0 when there are no more.
class Numbers {
public:
  Numbers(const std::uint8_t* bytes, std::size_t size) : bytes_{bytes}, size_{size} {}
  bool any() const { return size_ > 0; }
  std::uint32_t next() {
    std::uint32_t number = 0;
    const std::size_t taken = std::min(size_, sizeof number);
    std::memcpy(&number, bytes_, taken);
    bytes_ += taken;
    size_ -= taken;
    return number;
  }

private:
  const std::uint8_t* bytes_;
  std::size_t size_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  Numbers numbers{bytes, size};
  hal::LineFormat wanted;
  wanted.samples_per_line = static_cast<int>(numbers.next());
  wanted.lines_per_frame = static_cast<int>(numbers.next());
  const std::uint32_t packing = numbers.next();
  wanted.sample_type = packing % 2 == 0 ? hal::SampleType::u8 : hal::SampleType::u16;
  wanted.significant_bits = static_cast<int>(packing >> 8 & 0xFF);
  wanted.right_shift = static_cast<int>(packing >> 16 & 0xFF);
  GivenFormat given{numbers.next(), numbers.next(), numbers.next(),
                    numbers.next(), numbers.next(), numbers.next()};
  std::vector<OfferedFormat> offered;
  while (numbers.any() && offered.size() < 64) {
    OfferedFormat format;
    format.code = numbers.next();
    for (std::uint32_t sizes = numbers.next() % 4; sizes > 0; --sizes)
      format.sizes.push_back({{numbers.next(), numbers.next(), numbers.next()},
                              {numbers.next(), numbers.next(), numbers.next()}});
    offered.push_back(std::move(format));
  }
  const auto ranked = rank_formats(offered, wanted);
  if (!ranked)
    return 0;
  tests::expect(!ranked->empty(), "something is asked for, or refused");
  for (const FormatRequest& request : *ranked) {
    tests::expect(
        std::ranges::any_of(offered, [&](const auto& f) { return f.code == request.code; }),
        "what is asked for was offered");
    if (check_given(request, given))
      tests::expect(given.image_bytes >= wanted.frame_bytes(), "a frame fits");
  }
  return 0;
}
