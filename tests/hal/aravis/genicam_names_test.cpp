// Names of cameras and of pixel formats.
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>

#include "hal/linux/aravis/genicam_address.h"
#include "hal/linux/aravis/genicam_pixels.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::Depths;
using hal::linux_backend::GenicamAddress;
using hal::linux_backend::parse_genicam_address;
using testing::ElementsAre;
using Bus = GenicamAddress::Bus;

TEST(GenicamAddress, is_read_as_it_is_written) {
  for (const GenicamAddress& address :
       {GenicamAddress{Bus::usb3_vision, ""}, GenicamAddress{Bus::usb3_vision, "Vendor-0123"},
        GenicamAddress{Bus::gige_vision, "192.168.1.20"}}) {
    const auto read = parse_genicam_address(to_text(address));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(*read, address);
  }
}

TEST(GenicamAddress, other_cameras_are_none) {
  for (const char* other :
       {"auto", "sim", "v4l2", "/dev/video0", "usb3visions", "gigevisionx", ""}) {
    const auto read = parse_genicam_address(other);
    ASSERT_TRUE(read.has_value()) << other;
    EXPECT_EQ(*read, std::nullopt) << other;
  }
}

TEST(GenicamAddress, nothing_is_looked_for_on_a_network) {
  for (const char* wrong : {"gigevision", "gigevision:", "gigevision:camera.example",
                            "gigevision:Vendor-0123", "gigevision:192.168.1", "gigevision:fe80::1"})
    EXPECT_THAT(parse_genicam_address(wrong), FailsWith(hal::ErrorCode::invalid_argument)) << wrong;
}

TEST(GenicamAddress, a_camera_on_the_loopback_is_simulated) {
  EXPECT_TRUE((GenicamAddress{Bus::gige_vision, "127.0.0.1"}.simulated()));
  EXPECT_FALSE((GenicamAddress{Bus::gige_vision, "10.0.0.1"}.simulated()));
  EXPECT_FALSE((GenicamAddress{Bus::usb3_vision, "127.0.0.1"}.simulated()));
}

hal::LineFormat format(hal::SampleType type, int bits, int shift = 0) {
  return {.sample_type = type, .significant_bits = bits, .right_shift = shift};
}

std::vector<std::string_view> names_for(const hal::LineFormat& wanted,
                                        Depths depths = Depths::wanted) {
  std::vector<std::string_view> names;
  for (const auto& format : hal::linux_backend::genicam_formats_for(wanted, depths))
    names.push_back(format.name);
  return names;
}

TEST(GenicamPixels, a_packed_format_comes_first_then_one_that_says_its_bits) {
  using hal::SampleType;
  EXPECT_THAT(names_for(format(SampleType::u8, 8)), ElementsAre("Mono8"));
  EXPECT_THAT(names_for(format(SampleType::u16, 10)),
              ElementsAre("Mono10p", "Mono10Packed", "Mono10", "Mono16"));
  EXPECT_THAT(names_for(format(SampleType::u16, 12)),
              ElementsAre("Mono12p", "Mono12Packed", "Mono12", "Mono16"));
  EXPECT_THAT(names_for(format(SampleType::u16, 16)), ElementsAre("Mono16"));
  EXPECT_THAT(names_for(format(SampleType::u16, 12, 4)), ElementsAre("Mono16"));
}

TEST(GenicamPixels, where_any_depth_serves_the_wanted_comes_first_then_the_deepest) {
  using hal::SampleType;
  EXPECT_THAT(names_for(format(SampleType::u16, 12), Depths::any),
              ElementsAre("Mono12p", "Mono12Packed", "Mono12", "Mono16", "Mono14", "Mono10p",
                          "Mono10Packed", "Mono10", "Mono8"));
  EXPECT_THAT(names_for(format(SampleType::u8, 8), Depths::any), ElementsAre("Mono8"));
  EXPECT_THAT(names_for(format(SampleType::u16, 12, 4), Depths::any), ElementsAre("Mono16"));
}

TEST(GenicamPixels, of_the_whole_type_as_many_bits_are_taken_as_are_wanted_or_all) {
  using hal::linux_backend::choose_genicam_format;
  const std::vector<std::string> offered{"Mono16"};
  const hal::LineFormat wanted = format(hal::SampleType::u16, 12);
  EXPECT_EQ(choose_genicam_format(offered, wanted)->bits, 12);
  EXPECT_EQ(choose_genicam_format(offered, wanted, Depths::any)->bits, 16);
}

TEST(GenicamPixels, where_its_own_depth_is_wanted_one_that_has_a_deeper_is_refused) {
  using hal::linux_backend::choose_genicam_format;
  const auto choose = [](const std::vector<std::string>& offered, int bits) {
    return choose_genicam_format(offered, format(hal::SampleType::u16, bits), Depths::own);
  };
  EXPECT_EQ(choose({"Mono8", "Mono12"}, 12)->name, "Mono12");
  EXPECT_EQ(choose({"Mono12", "Mono16"}, 16)->name, "Mono16");
  for (const auto& offered : {std::vector<std::string>{"Mono12", "Mono16"}, {"Mono16"}, {"Mono8"}})
    EXPECT_THAT(choose(offered, 12), FailsWith(hal::ErrorCode::unsupported)) << offered.front();
}

TEST(GenicamPixels, lines_that_do_not_begin_at_a_byte_are_not_packed) {
  hal::LineFormat odd = format(hal::SampleType::u16, 12);
  odd.samples_per_line = 1022;
  EXPECT_THAT(names_for(odd), ElementsAre("Mono12", "Mono16"));
}

TEST(GenicamPixels, what_is_not_offered_is_told) {
  using hal::linux_backend::choose_genicam_format;
  const std::vector<std::string> offered{"BayerRG8", "Mono16", "Mono12"};
  const auto chosen = choose_genicam_format(offered, format(hal::SampleType::u16, 12));
  ASSERT_TRUE(chosen.has_value());
  EXPECT_EQ(chosen->name, "Mono12");
  const auto refused = choose_genicam_format(offered, format(hal::SampleType::u8, 8));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, hal::ErrorCode::unsupported);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("BayerRG8, Mono16, Mono12"));
  EXPECT_THAT(refused.error().message, testing::HasSubstr("expected Mono8"));
}

} // namespace
} // namespace octascope::tests
