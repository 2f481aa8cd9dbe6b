// Jobs beside a thread that must not wait. Each job is held back until the test lets it go: a call
// that waited for it would never return.
#include <memory>
#include <semaphore>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "pipeline/threads/background_task.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

TEST(BackgroundTask, is_polled_without_waiting_and_has_each_outcome_once) {
  std::binary_semaphore go{0};
  BackgroundTask<std::unique_ptr<std::string>> task;
  EXPECT_FALSE(task.busy());
  EXPECT_EQ(task.take(), std::nullopt) << "nothing was started";
  ASSERT_TRUE(task.start([&] {
    go.acquire();
    return std::make_unique<std::string>("written");
  }));
  EXPECT_TRUE(task.busy());
  EXPECT_EQ(task.take(), std::nullopt) << "it has not ended";
  go.release();
  task.wait();
  EXPECT_TRUE(task.busy()) << "its outcome was not taken";
  const auto outcome = tests::must(task.take());
  EXPECT_EQ(*outcome, "written");
  EXPECT_FALSE(task.busy());
  EXPECT_EQ(task.take(), std::nullopt) << "taken already";
  task.wait(); // for nothing
}

TEST(BackgroundTask, runs_one_job_at_a_time_on_a_thread_of_its_own) {
  std::binary_semaphore go{0};
  BackgroundTask<std::thread::id> task;
  const auto job = [&] {
    go.acquire();
    return std::this_thread::get_id();
  };
  bool second_ran = false;
  const auto second = [&] {
    second_ran = true;
    return std::thread::id{};
  };
  ASSERT_TRUE(task.start(job));
  EXPECT_FALSE(task.start(second)) << "the first one runs";
  go.release();
  task.wait();
  EXPECT_FALSE(task.start(second)) << "its outcome would be lost";
  const auto ran_on = tests::must(task.take());
  EXPECT_NE(ran_on, std::this_thread::get_id());
  EXPECT_FALSE(second_ran);
  EXPECT_TRUE(task.start(second));
  task.wait();
  EXPECT_TRUE(second_ran);
}

// The thread sanitizer sees it if the destructor does not wait.
TEST(BackgroundTask, waits_for_its_job_when_it_goes) {
  std::binary_semaphore go{0};
  int written = 0;
  {
    BackgroundTask<int> task;
    ASSERT_TRUE(task.start([&] {
      go.acquire();
      return written = 1;
    }));
    go.release();
  }
  EXPECT_EQ(written, 1);
}

} // namespace
} // namespace octascope::pipeline
