// The second half of the line camera's contract: loans, exhausted buffers, disconnects, threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "tests/contract/line_camera_contract.h"
#include "tests/support/allocation_counter.h"

namespace octascope::tests {

class LineCameraLoansContract : public LineCameraContract {
protected:
  std::vector<hal::LineFrame> take_all_buffers() {
    bench_->trigger();
    std::vector<hal::LineFrame> loans;
    for (int i = 0; i < bench_->config().buffers; ++i)
      loans.push_back(expect_frame());
    return loans;
  }

  void release(const std::vector<hal::LineFrame>& loans) {
    for (const hal::LineFrame& loan : loans)
      camera_.release(loan.buffer);
  }

  static std::vector<std::byte> copy_of(const hal::LineFrame& frame) {
    return {frame.bytes.begin(), frame.bytes.end()};
  }
};

TEST_P(LineCameraLoansContract, bytes_stay_readable_until_release_even_after_stop) {
  if (!bench_->driver_keeps_loans())
    GTEST_SKIP() << "this bench's driver writes into buffers on loan";
  open_and_start_with_few_buffers();
  const std::vector<hal::LineFrame> loans = take_all_buffers();
  std::vector<std::vector<std::byte>> copies;
  std::transform(loans.begin(), loans.end(), std::back_inserter(copies), copy_of);
  expect_no_frame(bench_->sweep_duration());
  camera_.stop();
  ASSERT_TRUE(camera_.start());
  for (std::size_t i = 0; i < loans.size(); ++i)
    EXPECT_EQ(copy_of(loans[i]), copies[i]);
  expect_no_frame({});
  release(loans);
  bench_->trigger();
  expect_frame();
}

TEST_P(LineCameraLoansContract, loans_have_different_buffers) {
  open_and_start_with_few_buffers();
  std::vector<int> numbers;
  for (const hal::LineFrame& loan : take_all_buffers())
    numbers.push_back(loan.buffer);
  std::sort(numbers.begin(), numbers.end());
  EXPECT_EQ(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

TEST_P(LineCameraLoansContract, without_buffers_frames_are_dropped_and_show_as_a_gap) {
  if (!bench_->driver_keeps_loans())
    GTEST_SKIP() << "this bench's driver writes into buffers on loan";
  open_and_start_with_few_buffers();
  const std::vector<hal::LineFrame> loans = take_all_buffers();
  expect_no_frame(bench_->sweep_duration() * 2);
  release(loans);
  bench_->trigger();
  EXPECT_EQ(expect_frame().sequence, static_cast<std::uint64_t>(bench_->frames_per_sweep()));
}

TEST_P(LineCameraLoansContract, strange_numbers_are_ignored) {
  if (!bench_->driver_keeps_loans())
    GTEST_SKIP() << "this bench's driver writes into buffers on loan";
  open_and_start_with_few_buffers();
  const std::vector<hal::LineFrame> loans = take_all_buffers();
  for (const int number :
       {-1, -2, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()})
    camera_.release(number);
  expect_no_frame(bench_->sweep_duration() * 2);

  // A loan given back twice makes room for one frame.
  camera_.release(loans.front().buffer);
  camera_.release(loans.front().buffer);
  bench_->trigger();
  EXPECT_EQ(expect_frame().buffer, loans.front().buffer);
  expect_no_frame(bench_->sweep_duration() * 2);
}

TEST_P(LineCameraLoansContract, streaming_allocates_nothing) {
  open_and_start();
  bench_->trigger();
  camera_.release(expect_frame().buffer);
  const std::uint64_t before = allocations_of_this_thread();
  int frames = 0;
  while (const auto frame = *camera_.wait_frame(bench_->sweep_duration())) {
    camera_.release(frame->buffer);
    ++frames;
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
  EXPECT_EQ(frames, bench_->frames_per_sweep() - 1);
}

TEST_P(LineCameraLoansContract, a_disconnect_is_told_and_survived) {
  if (!bench_->can_unplug())
    GTEST_SKIP() << "this bench cannot unplug its camera";
  open_and_start_with_few_buffers();
  const std::vector<hal::LineFrame> ended_loans = take_all_buffers();
  bench_->unplug();
  expect_fault(camera_.wait_frame(long_enough()), hal::ErrorCode::disconnected);
  EXPECT_EQ(camera_.state(), hal::DeviceState::failed);
  expect_fault(camera_.wait_frame({}), hal::ErrorCode::disconnected);
  expect_fault(camera_.start(), hal::ErrorCode::disconnected);
  expect_fault(camera_.open(bench_->config()), hal::ErrorCode::invalid_argument);
  camera_.stop();
  EXPECT_EQ(camera_.state(), hal::DeviceState::failed) << "only close leads out";
  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  release(ended_loans);
  expect_fault(camera_.open(bench_->config()), hal::ErrorCode::absent);
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);

  bench_->replug();
  clock_.sleep_for(bench_->sweep_duration() * 2);
  open_and_start_with_few_buffers();
  const std::vector<hal::LineFrame> loans = take_all_buffers();
  EXPECT_EQ(loans.front().sequence, 0U);
  release(loans);
}

TEST_P(LineCameraLoansContract, a_disconnect_before_start_is_told_by_start) {
  if (!bench_->can_unplug())
    GTEST_SKIP() << "this bench cannot unplug its camera";
  ASSERT_TRUE(camera_.open(bench_->config()));
  bench_->unplug();
  auto started = camera_.start();
  for (; !started && started.error().code == hal::ErrorCode::absent; started = camera_.start())
    EXPECT_EQ(camera_.state(), hal::DeviceState::ready) << "it goes on";
  expect_fault(started, hal::ErrorCode::disconnected);
  EXPECT_EQ(camera_.state(), hal::DeviceState::failed);
  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
}

// One thread fetches, another reads and gives back, a third triggers. What the sanitizers watch.
TEST_P(LineCameraLoansContract, another_thread_may_release) {
  constexpr int sweeps = 5;
  open_and_start_with_few_buffers();
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<hal::LineFrame> fetched; // guarded by mutex
  bool over = false;                  // guarded by mutex
  std::atomic<std::uint64_t> bytes_read{0};

  std::thread releasing{[&] {
    std::unique_lock lock{mutex};
    while (true) {
      changed.wait(lock, [&] { return over || !fetched.empty(); });
      if (fetched.empty())
        return;
      const hal::LineFrame frame = fetched.front();
      fetched.pop_front();
      lock.unlock();
      int sum = 0;
      for (const std::byte b : frame.bytes)
        sum += std::to_integer<int>(b);
      bytes_read += sum >= 0 ? frame.bytes.size() : 0;
      camera_.release(frame.buffer);
      lock.lock();
    }
  }};
  std::atomic<bool> triggered_all{false};
  std::thread triggering{[&] {
    for (int s = 0; s < sweeps; ++s) {
      bench_->trigger();
      clock_.sleep_for(bench_->sweep_duration());
    }
    triggered_all = true;
  }};

  std::uint64_t frames = 0;
  std::uint64_t next_sequence = 0;
  for (bool last_look = false; !last_look;) {
    last_look = triggered_all;
    while (const auto frame = *camera_.wait_frame(bench_->sweep_duration() * 2)) {
      EXPECT_GE(frame->sequence, next_sequence);
      next_sequence = frame->sequence + 1;
      ++frames;
      const std::lock_guard lock{mutex};
      fetched.push_back(*frame);
      changed.notify_one();
    }
  }
  triggering.join();
  {
    const std::lock_guard lock{mutex};
    over = true;
    changed.notify_one();
  }
  releasing.join();
  EXPECT_GT(frames, 0U);
  EXPECT_EQ(bytes_read, frames * bench_->config().format.frame_bytes());
}

} // namespace octascope::tests
