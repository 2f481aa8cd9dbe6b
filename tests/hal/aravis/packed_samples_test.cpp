// Packed samples, against the layouts' own definitions: bytes written down by hand, and every bit of
// a whole frame put where the definition says.
#include <array>
#include <vector>

#include <gmock/gmock.h>

#include "hal/linux/aravis/packed_samples.h"
#include "tests/hal/aravis/packed_by_definition.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::packed_bytes;
using hal::linux_backend::Packing;
using hal::linux_backend::unpack;

// Little-endian, as the program has them.
std::vector<int> samples_in(const std::vector<std::byte>& frame) {
  std::vector<int> samples;
  for (std::size_t i = 0; i + 1 < frame.size(); i += 2)
    samples.push_back(std::to_integer<int>(frame[i]) | std::to_integer<int>(frame[i + 1]) << 8);
  return samples;
}

std::vector<int> unpacked(Packing packing, std::vector<std::byte> bytes, std::size_t samples) {
  bytes.resize(samples * 2);
  unpack(packing, bytes, samples);
  return samples_in(bytes);
}

std::vector<std::byte> bytes(std::initializer_list<int> numbers) {
  std::vector<std::byte> all;
  for (const int number : numbers)
    all.push_back(static_cast<std::byte>(number));
  return all;
}

TEST(PackedSamples, lie_as_the_naming_convention_draws_them) {
  using testing::ElementsAre;
  EXPECT_THAT(unpacked(Packing::mono12p, bytes({0xBC, 0x3A, 0x12, 0xFF, 0x0F, 0x00}), 4),
              ElementsAre(0xABC, 0x123, 0xFFF, 0x000));
  EXPECT_THAT(unpacked(Packing::mono10p, bytes({0xAB, 0xCE, 0xC4, 0x0C, 0xFC}), 4),
              ElementsAre(0x2AB, 0x133, 0x0CC, 0x3F0));
  EXPECT_THAT(unpacked(Packing::mono12_packed, bytes({0xAB, 0x3C, 0x12, 0xFF, 0x0F, 0x00}), 4),
              ElementsAre(0xABC, 0x123, 0xFFF, 0x000));
  EXPECT_THAT(unpacked(Packing::mono10_packed, bytes({0xAA, 0x33, 0x4C, 0xFF, 0x03, 0x00}), 4),
              ElementsAre(0x2AB, 0x133, 0x3FF, 0x000));
}

TEST(PackedSamples, a_whole_frame_is_unpacked_where_it_lies) {
  for (const Packing packing :
       {Packing::mono10p, Packing::mono12p, Packing::mono10_packed, Packing::mono12_packed}) {
    std::vector<int> samples(4 * 333);
    const int most = bits_of(packing) == 10 ? 0x3FF : 0xFFF;
    for (std::size_t i = 0; i < samples.size(); ++i)
      samples[i] = static_cast<int>(i * 2654435761U >> 7U) & most;
    const std::vector<std::byte> packed = pack_by_definition(packing, samples);
    EXPECT_EQ(packed.size(), packed_bytes(packing, samples.size()));
    EXPECT_EQ(unpacked(packing, packed, samples.size()), samples);
  }
}

TEST(PackedSamples, of_8_bits_lie_in_words_of_16) {
  EXPECT_THAT(unpacked(Packing::mono8, bytes({0x00, 0x7F, 0x80, 0xFF, 1, 2, 3, 4}), 8),
              testing::ElementsAre(0x00, 0x7F, 0x80, 0xFF, 1, 2, 3, 4));
}

TEST(PackedSamples, of_another_depth_keep_their_share_of_full_scale) {
  for (const int from : {8, 10, 12, 14, 16})
    for (const int to : {8, 10, 12, 14, 16}) {
      if (to > 2 * from)
        continue;
      const int full_from = (1 << from) - 1;
      const int full_to = (1 << to) - 1;
      std::vector<std::byte> frame(2 * (static_cast<std::size_t>(full_from) + 1));
      for (int i = 0; i <= full_from; ++i) {
        frame[2 * static_cast<std::size_t>(i)] = static_cast<std::byte>(i & 0xFF);
        frame[2 * static_cast<std::size_t>(i) + 1] = static_cast<std::byte>(i >> 8);
      }
      hal::linux_backend::rescale(frame, frame.size() / 2, from, to);
      const std::vector<int> scaled = samples_in(frame);
      EXPECT_EQ(scaled.front(), 0);
      EXPECT_EQ(scaled.back(), full_to) << from << " to " << to;
      for (int i = 0; i <= full_from; ++i)
        ASSERT_NEAR(scaled[static_cast<std::size_t>(i)],
                    static_cast<double>(i) * full_to / full_from, 1)
            << i << " of " << from << " bits in " << to;
    }
}

TEST(PackedSamples, others_stay_as_they_are) {
  EXPECT_EQ(unpacked(Packing::none, bytes({1, 2, 3, 4}), 2), (std::vector{0x201, 0x403}));
}

} // namespace
} // namespace octascope::tests
