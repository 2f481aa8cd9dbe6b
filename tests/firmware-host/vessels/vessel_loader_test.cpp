// A tree that is loaded beside the display, and is not wanted any more.
#include <chrono>
#include <stop_token>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/vessels/vessel_files.h"
#include "firmware-host/vessels/vessel_loader.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/vessels/random_tree.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;

#ifdef OCTASCOPE_SANITIZED
constexpr int nodes = 100'000;
#else
constexpr int nodes = 1'000'000;
#endif

class VesselLoaderTest : public testing::Test {
protected:
  void SetUp() override { ASSERT_TRUE(write_tree(file_, tests::random_tree(nodes, 12), "by lot")); }

  static pipeline::TreeReadOptions forest() {
    pipeline::TreeReadOptions options;
    options.forest = true;
    return options;
  }

  tests::ScratchFolder folder_;
  std::filesystem::path file_ = folder_ / "tree.swc";
};

TEST_F(VesselLoaderTest, hands_over_the_tree_once) {
  pipeline::Wakeup news;
  VesselLoader loader{file_, news};
  auto taken = loader.take();
  while (!taken) {
    std::this_thread::sleep_for(1ms);
    if (auto now = loader.take())
      taken.emplace(std::move(*now));
  }
  ASSERT_TRUE(*taken) << taken->error().message;
  EXPECT_EQ((*taken)->facts().nodes, static_cast<std::uint64_t>(nodes) + 3);
  EXPECT_EQ(loader.progress(), 1);
  EXPECT_FALSE(loader.take());
}

// At whatever point: what the destructor waits for is counted as work below, and not in time here.
TEST_F(VesselLoaderTest, is_broken_off_wherever_it_is) {
  for (const float at : {0.0F, 0.2F, 0.4F, 0.6F, 0.8F}) {
    pipeline::Wakeup news;
    VesselLoader loader{file_, news};
    while (loader.progress() < at)
      std::this_thread::sleep_for(100us);
  }
}

TEST_F(VesselLoaderTest, says_that_it_was_broken_off_and_soon) {
  for (const double at : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}) {
    std::stop_source stop;
    pipeline::TreeReadOptions options = forest();
    options.stop = stop.get_token();
    double asked = 1;
    double reached = 0;
    options.progress = [&](double done) {
      reached = done;
      if (done >= at && stop.request_stop())
        asked = done;
    };
    const auto loaded = load_vessels(file_, options);
    ASSERT_FALSE(loaded) << at;
    EXPECT_EQ(loaded.error().code, hal::ErrorCode::disconnected);
    EXPECT_THAT(loaded.error().message, testing::HasSubstr("tree.swc: reading was broken off"));
    EXPECT_LE(reached - asked, 0.12) << "of the work was still done, having been told at " << asked;
  }
}

} // namespace
} // namespace octascope::firmware_host
