// What comes as bytes from the kernel and from monitors: EDIDs, events, lists of formats.
#include <array>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <drm.h>
#include <drm_mode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/kms/drm/edid.h"
#include "hal/linux/kms/drm/format_blob.h"
#include "hal/linux/kms/scanout/flip_events.h"
#include "tests/support/files/mutation.h"

namespace octascope::tests {
namespace {

using namespace hal::linux_backend::kms;
using testing::ElementsAre;

// A base block made by "DEL", product 0xa0c4, with a descriptor of the given kind and text.
std::vector<std::uint8_t> edid_of(const std::string& text, std::uint8_t kind = 0xfc) {
  std::vector<std::uint8_t> edid(128);
  std::fill(edid.begin() + 1, edid.begin() + 7, std::uint8_t{0xff});
  constexpr unsigned maker = 4U << 10 | 5U << 5 | 12U; // D, E, L
  edid[8] = maker >> 8;
  edid[9] = maker & 0xff;
  edid[10] = 0xc4;
  edid[11] = 0xa0;
  edid[54] = 1; // the first descriptor is a timing
  edid[72 + 3] = kind;
  for (std::size_t i = 0; i < 13; ++i)
    edid[72 + 5 + i] = static_cast<std::uint8_t>(i < text.size()    ? text[i]
                                                 : i == text.size() ? '\n'
                                                                    : ' ');
  return edid;
}

std::string name_of(std::vector<std::uint8_t> edid) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < 127; ++i)
    sum += edid[i];
  edid[127] = static_cast<std::uint8_t>(256 - sum % 256);
  return monitor_name(edid);
}

TEST(MonitorName, is_what_the_monitor_says) {
  EXPECT_EQ(name_of(edid_of("DELL U2415")), "DELL U2415");
  EXPECT_EQ(name_of(edid_of("THIRTEEN CHAR")), "THIRTEEN CHAR");
  EXPECT_EQ(name_of(edid_of("in  between  ")), "in  between");
  EXPECT_EQ(name_of(edid_of("\x1b[31m")), "?[31m") << "nothing that a terminal obeys";
}

TEST(MonitorName, is_maker_and_product_where_there_is_none) {
  EXPECT_EQ(name_of(edid_of("serial 1", 0xff)), "DEL a0c4");
  EXPECT_EQ(name_of(edid_of("")), "DEL a0c4");
}

TEST(MonitorName, is_empty_where_the_bytes_are_no_edid) {
  std::vector<std::uint8_t> edid = edid_of("DELL U2415");
  EXPECT_EQ(monitor_name(edid), "") << "wrong sum";
  EXPECT_EQ(monitor_name({}), "");
  edid.resize(127);
  EXPECT_EQ(monitor_name(edid), "");
  edid = edid_of("DELL U2415");
  edid[0] = 1;
  EXPECT_EQ(name_of(edid), "");
}

TEST(MonitorName, of_any_bytes_is_short_and_printable) {
  std::mt19937_64 random{17};
  for (int i = 0; i < 20000; ++i) {
    auto edid = edid_of("DELL U2415");
    for (std::size_t changes = random() % 20; changes > 0; --changes)
      edid[8 + random() % 120] = static_cast<std::uint8_t>(random());
    const std::string name = name_of(edid);
    ASSERT_LE(name.size(), 13U);
    for (const char c : name)
      ASSERT_TRUE(c >= 0x20 && c < 0x7f);
  }
}

template <class Value> void append(std::vector<std::byte>& bytes, const Value& value) {
  const std::size_t before = bytes.size();
  bytes.resize(before + sizeof value);
  std::memcpy(bytes.data() + before, &value, sizeof value);
}

drm_event_vblank event_of(std::uint32_t type, std::uint64_t number) {
  drm_event_vblank event{};
  event.base = {type, sizeof event};
  event.user_data = number;
  event.tv_sec = 12;
  event.tv_usec = 345678;
  return event;
}

std::vector<std::uint64_t> numbers_in(std::span<const std::byte> bytes) {
  std::vector<std::uint64_t> numbers;
  while (const auto flip = take_flip(bytes))
    numbers.push_back(flip->number);
  EXPECT_TRUE(bytes.empty());
  return numbers;
}

TEST(FlipEvents, are_found_among_others_with_their_time) {
  std::vector<std::byte> bytes;
  append(bytes, event_of(DRM_EVENT_VBLANK, 1));
  append(bytes, event_of(DRM_EVENT_FLIP_COMPLETE, 7));
  append(bytes, drm_event{0x1234, sizeof(drm_event)});
  append(bytes, event_of(DRM_EVENT_FLIP_COMPLETE, 8));
  EXPECT_THAT(numbers_in(bytes), ElementsAre(7, 8));
  std::span<const std::byte> rest{bytes};
  EXPECT_EQ(take_flip(rest)->stamp.time_since_epoch().count(), 12'345'678'000);
}

TEST(FlipEvents, end_where_one_is_broken) {
  std::vector<std::byte> bytes;
  append(bytes, event_of(DRM_EVENT_FLIP_COMPLETE, 7));
  append(bytes, drm_event{DRM_EVENT_FLIP_COMPLETE, 0}); // would be read for ever
  append(bytes, event_of(DRM_EVENT_FLIP_COMPLETE, 8));
  EXPECT_THAT(numbers_in(bytes), ElementsAre(7));
  bytes.resize(20);
  EXPECT_THAT(numbers_in(bytes), ElementsAre());
}

TEST(FlipEvents, of_any_bytes_end) {
  std::mt19937_64 random{23};
  std::vector<std::byte> good;
  for (std::uint64_t i = 0; i < 5; ++i)
    append(good, event_of(DRM_EVENT_FLIP_COMPLETE, i));
  const std::string text{reinterpret_cast<const char*>(good.data()), good.size()};
  for (int i = 0; i < 20000; ++i) {
    const std::string bad = mutate(text, random);
    ASSERT_LE(numbers_in(std::as_bytes(std::span{bad})).size(), bad.size() / 32);
  }
}

// Two formats; the second modifier is for the second one only.
std::vector<std::byte> format_blob() {
  std::vector<std::byte> bytes;
  drm_format_modifier_blob head{};
  head.version = FORMAT_BLOB_CURRENT;
  head.count_formats = 2;
  head.formats_offset = sizeof head;
  head.count_modifiers = 2;
  head.modifiers_offset = sizeof head + 2 * sizeof(std::uint32_t);
  append(bytes, head);
  append(bytes, std::uint32_t{100});
  append(bytes, std::uint32_t{200});
  append(bytes, drm_format_modifier{3, 0, 0, 11});
  append(bytes, drm_format_modifier{1, 1, 0, 12});
  return bytes;
}

TEST(FormatBlob, says_which_layouts_belong_to_which_format) {
  std::vector<std::pair<unsigned, std::uint64_t>> pairs;
  for (const FormatModifier& pair : decode_formats(format_blob()))
    pairs.emplace_back(pair.format, pair.modifier);
  EXPECT_THAT(pairs, ElementsAre(std::pair{100U, 11U}, std::pair{200U, 11U}, std::pair{200U, 12U}));
}

TEST(FormatBlob, of_any_bytes_is_read_within_them) {
  std::mt19937_64 random{29};
  const auto good = format_blob();
  const std::string text{reinterpret_cast<const char*>(good.data()), good.size()};
  for (int i = 0; i < 20000; ++i) {
    const std::string bad = mutate(text, random);
    ASSERT_LE(decode_formats(std::as_bytes(std::span{bad})).size(), 64 * bad.size());
  }
}

} // namespace
} // namespace octascope::tests
