// Pictures of a patient: for nobody but their owner, never one in another's place, and not kept in
// silence when they cannot be.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "firmware-host/outputs/picture_writer.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

namespace fs = std::filesystem;

// Noise, so that it does not shrink to nothing.
pipeline::Image picture() {
  std::mt19937 random{3};
  pipeline::Image image{64, 48, 3};
  std::ranges::generate(image.pixels, [&] { return static_cast<std::uint8_t>(random()); });
  return image;
}

class KeptPictures : public testing::Test {
protected:
  // As a service's umask may be at its worst.
  KeptPictures() : umask_(::umask(0)) {}
  ~KeptPictures() override { ::umask(umask_); }

  // Each is written before the next is asked for.
  void keep(int pictures) {
    for (int i = 0; i < pictures; ++i) {
      PictureWriter keeper{folder_.path(), clock_, faults_};
      EXPECT_TRUE(keeper.keep(picture()));
    }
  }

  tests::ScratchFolder folder_;
  hal::linux_backend::MonotonicClock clock_;
  pipeline::FaultLog faults_;

private:
  ::mode_t umask_;
};

TEST_F(KeptPictures, are_readable_by_their_owner_alone) {
  keep(1);
  ASSERT_EQ(folder_.count(), 1);
  const fs::directory_entry file = *fs::directory_iterator{folder_.path()};
  EXPECT_EQ(file.status().permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(faults_.records().empty());
}

// Many in a second, or the same second twice because the clock was set back.
TEST_F(KeptPictures, never_replace_one_another) {
  keep(5);
  EXPECT_EQ(folder_.count(), 5);
}

// Quicker than the disk takes them; the first is being written, or has been.
TEST_F(KeptPictures, that_come_together_are_all_written_up_to_a_limit) {
  const int asked = 40;
  int kept = 0;
  {
    PictureWriter keeper{folder_.path(), clock_, faults_};
    for (int i = 0; i < asked; ++i)
      kept += keeper.keep(picture()) ? 1 : 0;
  }
  EXPECT_GE(kept, 1 + static_cast<int>(PictureWriter::most_waiting));
  EXPECT_EQ(folder_.count(), kept);
  for (const auto& record : faults_.records()) {
    EXPECT_EQ(record.kind, pipeline::Fault::picture_not_kept);
    EXPECT_EQ(static_cast<int>(record.count), asked - kept);
  }
}

// A limit on the size of files stands for a disk without room.
TEST_F(KeptPictures, that_find_no_room_are_told_and_leave_nothing) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  keep(1);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(folder_.count(), 0);
  ASSERT_EQ(faults_.records().size(), 1U);
  EXPECT_EQ(faults_.records()[0].kind, pipeline::Fault::picture_not_kept);
}

} // namespace
} // namespace octascope::firmware_host
