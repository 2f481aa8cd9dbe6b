#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include "firmware-host/supervision/thread_roles.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/realtime.h"

namespace octascope::firmware_host {
namespace {

using hal::linux_backend::allowed_cores;

TEST(WorkerCores, spread_over_the_allowed_ones) {
  const std::vector allowed{1, 4, 6};
  const WorkerCores cores{3, {}, allowed};
  EXPECT_EQ(cores.planned(0), 1);
  EXPECT_EQ(cores.planned(2), 6);
  EXPECT_EQ(cores.pinned(), (std::vector{-1, -1, -1})) << "none has started";
}

TEST(WorkerCores, with_more_workers_than_cores_the_system_chooses) {
  const std::vector allowed{0, 1};
  EXPECT_FALSE((WorkerCores{3, {}, allowed}.planned(0)));
  EXPECT_FALSE((WorkerCores{1, {}, {}}.planned(0)));
}

TEST(WorkerCores, configured_ones_are_taken_in_turns) {
  const std::vector configured{5, 3};
  const std::vector allowed{0, 1, 2, 3, 4, 5};
  const WorkerCores cores{3, configured, allowed};
  EXPECT_EQ(cores.planned(0), 5);
  EXPECT_EQ(cores.planned(1), 3);
  EXPECT_EQ(cores.planned(2), 5);
}

// What the setup does to a thread with this role.
std::vector<int> cores_after(const pipeline::ThreadSetup& setup, pipeline::ThreadRole role) {
  std::vector<int> left;
  std::thread{[&] {
    setup(role);
    left.clear();
    cpu_set_t set;
    CPU_ZERO(&set);
    pthread_getaffinity_np(pthread_self(), sizeof(set), &set);
    for (int core = 0; core < CPU_SETSIZE; ++core) {
      if (CPU_ISSET(static_cast<std::size_t>(core), &set))
        left.push_back(core);
    }
  }}.join();
  return left;
}

TEST(ThreadSetup, pins_workers_and_nobody_else) {
  hal::linux_backend::MonotonicClock clock;
  pipeline::FaultLog faults;
  const std::vector<int> allowed = allowed_cores();
  ASSERT_FALSE(allowed.empty());
  WorkerCores cores{2, std::vector{allowed.back()}, allowed};
  const auto setup = make_thread_setup(clock, faults, cores);
  EXPECT_EQ(cores_after(setup, {"worker", 1}), std::vector{allowed.back()});
  EXPECT_EQ(cores_after(setup, {"volumes"}), allowed);
  EXPECT_EQ(cores.pinned(), (std::vector{-1, allowed.back()}));
}

// The nice value that the setup leaves a thread with this role, and its scheduling.
std::pair<int, int> niceness_after(const pipeline::ThreadSetup& setup, pipeline::ThreadRole role) {
  std::pair<int, int> left;
  std::thread{[&] {
    setup(role);
    left = {getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())), sched_getscheduler(0)};
  }}.join();
  return left;
}

TEST(ThreadSetup, those_that_help_drawing_are_ordinary_and_the_surface_comes_last) {
  hal::linux_backend::MonotonicClock clock;
  pipeline::FaultLog faults;
  WorkerCores cores{1, {}, allowed_cores()};
  const auto setup = make_thread_setup(clock, faults, cores);
  const int ours = getpriority(PRIO_PROCESS, 0);
  EXPECT_EQ(niceness_after(setup, {"rays", 0}), (std::pair{ours, SCHED_OTHER}));
  EXPECT_EQ(niceness_after(setup, {"surface"}), (std::pair{ours, SCHED_IDLE}));
  EXPECT_EQ(cores.pinned(), std::vector{-1}) << "a helper is no worker";
}

TEST(ThreadSetup, a_core_that_is_not_there_is_a_fault_and_no_more) {
  hal::linux_backend::MonotonicClock clock;
  pipeline::FaultLog faults;
  WorkerCores cores{1, std::vector{1023}, allowed_cores()};
  EXPECT_EQ(cores_after(make_thread_setup(clock, faults, cores), {"worker", 0}), allowed_cores());
  EXPECT_EQ(cores.pinned(), std::vector{-1});
  std::vector<pipeline::Fault> kinds;
  for (const auto& record : faults.records())
    kinds.push_back(record.kind);
  EXPECT_THAT(kinds, testing::Contains(pipeline::Fault::not_pinned));
}

} // namespace
} // namespace octascope::firmware_host
