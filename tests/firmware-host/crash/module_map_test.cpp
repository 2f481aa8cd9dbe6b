// From addresses to modules, and figures without the standard library: what a crash's report is
// made of.
#include <array>
#include <ctime>
#include <memory>
#include <random>
#include <string>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "firmware-host/crash/module_map.h"
#include "firmware-host/crash/signal_text.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

TEST(ModuleMap, counts_from_where_a_module_begins) {
  const tests::ScratchFolder folder;
  const auto file =
      folder.write("maps", "1000-2000 r--p 00000000 08:01 12                 /usr/bin/octascope\n"
                           "2000-5000 r-xp 00001000 08:01 12                 /usr/bin/octascope\n"
                           "5000-6000 rw-p 00000000 00:00 0 \n"
                           "7000-8000 r-xp 00000000 08:01 13                 /usr/lib/a b.so\n"
                           "9000-a000 r-xp 00000000 00:00 0                  [vdso]");
  const auto map = std::make_unique<ModuleMap>();
  map->read(file.c_str());
  EXPECT_EQ(map->find(0x2345).module, "/usr/bin/octascope");
  EXPECT_EQ(map->find(0x2345).offset, 0x1345U);
  EXPECT_EQ(map->find(0x7fff).module, "/usr/lib/a b.so");
  EXPECT_EQ(map->find(0x7fff).offset, 0xfffU);
  EXPECT_EQ(map->find(0x9001).module, "[vdso]");
  EXPECT_EQ(map->find(0x5001).module, "") << "memory of no module";
  for (const std::uint64_t nowhere : {0x0U, 0xfffU, 0x6000U, 0x8000U, 0xa000U})
    EXPECT_EQ(map->find(nowhere).module, "") << nowhere;
}

TEST(ModuleMap, finds_this_very_test) {
  const auto map = std::make_unique<ModuleMap>();
  map->read();
  const auto here = reinterpret_cast<std::uint64_t>(&tests::fresh_seed);
  EXPECT_THAT(std::string{map->find(here).module}, EndsWith("test_firmware_host"));
  // A function that no sanitizer puts itself in front of.
  const auto in_the_library = reinterpret_cast<std::uint64_t>(&::sysconf);
  EXPECT_THAT(std::string{map->find(in_the_library).module}, HasSubstr("libc"));
}

TEST(ModuleMap, of_a_file_that_is_not_there_is_empty) {
  const auto map = std::make_unique<ModuleMap>();
  map->read("/nowhere");
  EXPECT_EQ(map->find(1).module, "");
}

TEST(SignalText, writes_figures_as_everybody_does) {
  std::mt19937_64 random{tests::fresh_seed()};
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t value = random() >> (random() % 64);
    SignalText text;
    text.number(value).text(" ").hex(value).text(" ").number(value, 4);
    EXPECT_EQ(text.gathered(), fmt::format("{} {:#x} {:04}", value, value, value));
  }
}

TEST(SignalText, writes_days_of_all_years_as_everybody_does) {
  std::mt19937_64 random{tests::fresh_seed()};
  for (int i = 0; i < 1000; ++i) {
    const auto time = static_cast<std::time_t>(random() % (500ULL * 366 * 86400));
    SignalText text;
    text.time(time);
    EXPECT_EQ(text.gathered(), fmt::format("{:%Y%m%d-%H%M%S}", fmt::gmtime(time)));
  }
}

} // namespace
} // namespace octascope::firmware_host
