// A machine in trouble, played by a folder that looks like its /proc and /sys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/supervision/host_watch.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using pipeline::Fault;
using testing::ElementsAre;
using testing::IsEmpty;

class HostTrouble : public testing::Test {
protected:
  HostTrouble() {
    add("proc/meminfo", "MemTotal:        8000000 kB\nMemAvailable:    4000000 kB\n");
    add("proc/pressure/memory", "some avg10=1.00 avg60=0.00\nfull avg10=0.50 avg60=0.00\n");
    add("proc/self/status", "Name:\toctascope\nVmRSS:\t  204800 kB\n");
    add("sys/class/thermal/thermal_zone0/temp", "45000\n");
    add("sys/class/thermal/thermal_zone1/temp", "61500\n");
    add("sys/class/thermal/thermal_zone1/trip_point_0_temp", "60000\n");
    add("sys/class/thermal/thermal_zone1/trip_point_0_type", "active\n");
    add("sys/class/thermal/thermal_zone1/trip_point_1_temp", "85000\n");
    add("sys/class/thermal/thermal_zone1/trip_point_1_type", "passive\n");
    add("sys/devices/system/cpu/cpu0/thermal_throttle/core_throttle_count", "3\n");
    add("sys/devices/system/cpu/cpu1/thermal_throttle/core_throttle_count", "4\n");
  }

  void add(const std::string& file, std::string_view text) {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    folder_.write(file, text);
  }

  // The kinds of faults that the next look, a second later, brings.
  std::vector<Fault> look() {
    pipeline::FaultLog faults;
    now_ += 1s;
    wall_ += 1s;
    watch_.look(faults, now_);
    std::vector<Fault> kinds;
    for (const auto& fault : faults.records())
      kinds.push_back(fault.kind);
    return kinds;
  }

  tests::ScratchFolder folder_;
  std::uint64_t free_bytes_ = 1ULL << 40U;
  hal::TimePoint now_{5000s};
  std::chrono::nanoseconds wall_ = 1'700'000'000s;
  HostWatch watch_{{.root = folder_.path(),
                    .written = {"/anywhere"},
                    .disk_space = [this](const auto&) { return DiskSpace{free_bytes_}; },
                    .wall_clock = [this] { return wall_; }}};
};

TEST_F(HostTrouble, is_none_on_a_sound_machine) {
  for (int i = 0; i < 3; ++i)
    EXPECT_THAT(look(), IsEmpty());
  EXPECT_EQ(watch_.findings().resident_bytes, 200ULL << 20U);
  EXPECT_EQ(watch_.findings().temperature_c, 61.5);
  EXPECT_EQ(watch_.findings().throttlings, 7U);
}

TEST_F(HostTrouble, a_full_disk) {
  free_bytes_ = HostWatch::least_disk_bytes - 1;
  EXPECT_THAT(look(), ElementsAre(Fault::disk_full));
  EXPECT_THAT(look(), ElementsAre(Fault::disk_full)) << "for as long as it lasts";
  free_bytes_ = HostWatch::least_disk_bytes;
  EXPECT_THAT(look(), IsEmpty());
}

TEST_F(HostTrouble, a_clock_that_jumps_either_way) {
  look();
  for (const auto jump : {3600s, -3600s, 2s, -2s}) {
    wall_ += jump;
    EXPECT_THAT(look(), ElementsAre(Fault::clock_jump)) << jump.count();
    EXPECT_THAT(look(), IsEmpty()) << "once";
  }
  for (int i = 0; i < 100; ++i) { // a clock that is slewed, not set
    wall_ += 50ms;
    EXPECT_THAT(look(), IsEmpty());
  }
}

TEST_F(HostTrouble, too_little_memory) {
  add("proc/meminfo", "MemAvailable:    50000 kB\n");
  EXPECT_THAT(look(), ElementsAre(Fault::low_memory));
  add("proc/meminfo", "MemAvailable:    4000000 kB\n");
  EXPECT_THAT(look(), IsEmpty());
  add("proc/pressure/memory", "some avg10=60.00 avg60=0.00\nfull avg10=30.00 avg60=0.00\n");
  EXPECT_THAT(look(), ElementsAre(Fault::low_memory));
}

TEST_F(HostTrouble, heat) {
  look();
  add("sys/devices/system/cpu/cpu1/thermal_throttle/core_throttle_count", "5\n");
  EXPECT_THAT(look(), ElementsAre(Fault::throttled));
  EXPECT_THAT(look(), IsEmpty());
  add("sys/class/thermal/thermal_zone1/temp", "85000\n");
  EXPECT_THAT(look(), ElementsAre(Fault::throttled));
}

TEST_F(HostTrouble, is_not_made_up_where_a_machine_says_nothing) {
  std::filesystem::remove_all(folder_ / "proc");
  std::filesystem::remove_all(folder_ / "sys");
  EXPECT_THAT(look(), IsEmpty());
  EXPECT_THAT(look(), IsEmpty());
}

TEST(Host, says_something_of_itself) {
  const HostFindings findings = find_out_about_host();
  ASSERT_TRUE(findings.available_bytes);
  ASSERT_TRUE(findings.resident_bytes);
  EXPECT_GT(*findings.resident_bytes, 1U << 20U);
}

} // namespace
} // namespace octascope::firmware_host
