// Recordings: what is written is read again, at any moment, and however the writer ended.
#include <csignal>
#include <functional>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pipeline/recordings/recording_reader.h"
#include "pipeline/recordings/recording_writer.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/size_limit.h"
#include "tests/support/files/small_recording.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using tests::append_small_volumes;
using tests::small_recording_entry;
using tests::small_recording_facts;
using tests::small_recording_volume;
using tests::write_small_recording;

class Recording : public testing::Test {
protected:
  std::string refusal(const std::filesystem::path& path) {
    const auto opened = RecordingReader::open(path);
    if (opened)
      return {};
    EXPECT_THAT(opened.error().message, HasSubstr(path.string()));
    return opened.error().message;
  }
  void expect_volumes(std::uint64_t count) {
    auto reader = tests::must(RecordingReader::open(file));
    ASSERT_EQ(reader.volumes().size(), count);
    Volume volume{small_recording_facts().geometry};
    for (std::uint64_t n = 0; n < count; ++n) {
      EXPECT_EQ(reader.volumes()[n], small_recording_entry(n));
      const auto read = reader.read(n, volume);
      ASSERT_TRUE(read) << read.error().message;
      const Volume written = small_recording_volume(n);
      EXPECT_EQ(volume.levels, written.levels) << "volume " << n;
      EXPECT_EQ(volume.b_scan_states, written.b_scan_states);
      EXPECT_EQ(volume.metadata.index, written.metadata.index);
      EXPECT_EQ(volume.metadata.last_line, written.metadata.last_line);
      EXPECT_EQ(volume.metadata.published, written.metadata.published);
    }
  }

  tests::ScratchFolder folder;
  const std::filesystem::path file = folder / "r.h5";
};

TEST_F(Recording, is_read_as_it_was_written) {
  write_small_recording(file, 5);
  expect_volumes(5);
  const auto reader = tests::must(RecordingReader::open(file));
  const RecordingFacts& facts = reader.facts();
  const RecordingFacts written = small_recording_facts();
  EXPECT_EQ(facts.geometry, written.geometry);
  EXPECT_EQ(facts.volume_period_s, written.volume_period_s);
  EXPECT_EQ(facts.recorded_by, written.recorded_by);
  EXPECT_EQ(facts.begun, written.begun);
  EXPECT_EQ(facts.source, written.source);
  EXPECT_EQ(facts.simulated, written.simulated);
  EXPECT_EQ(facts.subject, written.subject);
  EXPECT_EQ(facts.eye, written.eye);
  EXPECT_EQ(facts.configuration, written.configuration);
  EXPECT_TRUE(reader.end().finished);
  EXPECT_EQ(reader.end().not_kept, 2U);
}

TEST_F(Recording, may_hold_nothing_and_say_nothing) {
  RecordingFacts facts = small_recording_facts();
  facts.subject.clear();
  facts.eye = Eye::not_said;
  facts.configuration.clear();
  {
    auto writer = tests::must(RecordingWriter::create(file, facts));
    ASSERT_TRUE(writer.finish({}));
  }
  const auto reader = tests::must(RecordingReader::open(file));
  EXPECT_EQ(reader.facts().subject, "");
  EXPECT_EQ(reader.facts().eye, Eye::not_said);
  EXPECT_TRUE(reader.volumes().empty());
}

TEST_F(Recording, can_be_read_by_its_owner_only) {
  const auto umask_before = ::umask(0);
  write_small_recording(file, 1);
  ::umask(umask_before);
  EXPECT_EQ(std::filesystem::status(file).permissions(), std::filesystem::perms{0600});
}

TEST_F(Recording, is_never_written_over) {
  write_small_recording(file, 3);
  const auto again = tests::error_of(RecordingWriter::create(file, small_recording_facts()));
  EXPECT_EQ(again.code, hal::ErrorCode::invalid_argument);
  EXPECT_THAT(again.message, HasSubstr("never written over"));
  expect_volumes(3);
}

TEST_F(Recording, into_a_missing_folder_is_refused) {
  EXPECT_THAT(RecordingWriter::create(folder / "none/r.h5", small_recording_facts()),
              tests::FailsWith(hal::ErrorCode::absent));
}

TEST_F(Recording, takes_no_volume_of_another_geometry) {
  auto writer = tests::must(RecordingWriter::create(file, small_recording_facts()));
  VolumeGeometry other = small_recording_facts().geometry;
  ++other.depths;
  EXPECT_FALSE(writer.append(Volume{other}, {}));
  append_small_volumes(writer, 0, 2); // it still takes its own
}

TEST_F(Recording, that_was_dropped_holds_what_came) {
  {
    auto writer = tests::must(RecordingWriter::create(file, small_recording_facts()));
    append_small_volumes(writer, 0, 4);
  }
  expect_volumes(4);
  EXPECT_FALSE(RecordingReader::open(file)->end().finished);
}

// The same process as in a crash: nothing is closed, nothing flushed on the way out.
TEST_F(Recording, of_a_program_that_was_killed_holds_what_came) {
  const pid_t child = ::fork();
  if (child == 0) {
    auto writer = RecordingWriter::create(file, small_recording_facts());
    for (std::uint64_t n = 0; n < 6; ++n)
      static_cast<void>(writer->append(small_recording_volume(n), small_recording_entry(n)));
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  expect_volumes(6);
  EXPECT_FALSE(RecordingReader::open(file)->end().finished);
}

// What cannot be written any more is left as it was, and closed by nobody.
TEST_F(Recording, whose_disk_refused_to_be_written_holds_what_came) {
  const pid_t child = ::fork();
  if (child == 0) {
    bool failed = false;
    {
      auto writer = RecordingWriter::create(file, small_recording_facts());
      for (std::uint64_t n = 0; n < 200 && !failed; ++n) {
        failed = !writer->append(small_recording_volume(n), small_recording_entry(n));
        if (n == 5)
          tests::limit_file_sizes(std::filesystem::file_size(file));
      }
      failed = failed && !writer->finish({});
    }
    ::_exit(failed ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  const auto reader = tests::must(RecordingReader::open(file));
  EXPECT_GE(reader.volumes().size(), 6U);
  expect_volumes(reader.volumes().size());
  EXPECT_FALSE(reader.end().finished);
}

// By another process: HDF5 does not share a file with itself.
TEST_F(Recording, can_be_read_while_it_is_written) {
  auto writer = tests::must(RecordingWriter::create(file, small_recording_facts()));
  for (std::uint64_t n = 0; n < 4; ++n) {
    append_small_volumes(writer, n, n + 1);
    const pid_t child = ::fork();
    if (child == 0) {
      auto reader = RecordingReader::open(file);
      Volume volume{small_recording_facts().geometry};
      const bool right = reader && reader->volumes().size() == n + 1 && reader->read(n, volume) &&
                         volume.levels == small_recording_volume(n).levels;
      ::_exit(right ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0) << "after volume " << n;
  }
}

TEST_F(Recording, that_outgrows_the_disk_says_so_and_keeps_what_it_has) {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit small{40'000, 40'000};
    ::setrlimit(RLIMIT_FSIZE, &small);
    std::signal(SIGXFSZ, SIG_IGN);
    auto writer = RecordingWriter::create(file, small_recording_facts());
    hal::Result<> appended;
    std::uint64_t n = 0;
    for (; n < 1000 && appended; ++n)
      appended = writer->append(small_recording_volume(n), small_recording_entry(n));
    const bool told = !appended && appended.error().message.find("r.h5") != std::string::npos &&
                      !writer->append(small_recording_volume(n), small_recording_entry(n));
    ::_exit(told && n > 10 ? static_cast<int>(n - 1) : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_GT(WEXITSTATUS(status), 0);
  const auto reader = tests::must(RecordingReader::open(file));
  EXPECT_GE(reader.volumes().size() + 1, static_cast<std::size_t>(WEXITSTATUS(status)));
}

// What becomes of its file while it is written: told, and nobody else's file is touched.
TEST_F(Recording, knows_where_its_file_has_gone) {
  const auto other = folder / "other.h5";
  const auto told_after = [&](const std::function<void()>& happen) {
    std::filesystem::remove(file);
    std::filesystem::remove(other);
    auto writer = tests::must(RecordingWriter::create(file, small_recording_facts()));
    append_small_volumes(writer, 0, 3);
    EXPECT_TRUE(writer.sync());
    happen();
    const auto synced = tests::error_of(writer.sync());
    EXPECT_EQ(synced.code, hal::ErrorCode::absent);
    EXPECT_THAT(synced.message, HasSubstr(file.string() + ": "));
    const auto finished = tests::error_of(writer.finish({}));
    EXPECT_EQ(finished.code, hal::ErrorCode::absent);
    EXPECT_EQ(finished.message, synced.message);
    return finished.message;
  };
  EXPECT_THAT(told_after([&] { std::filesystem::remove(file); }),
              AllOf(HasSubstr("was removed or moved"), HasSubstr("what was recorded is lost")));

  EXPECT_THAT(told_after([&] { std::filesystem::rename(file, other); }),
              AllOf(HasSubstr("was removed or moved"), HasSubstr("is in " + other.string())));
  const auto moved = tests::must(RecordingReader::open(other));
  EXPECT_TRUE(moved.end().finished);
  EXPECT_EQ(moved.volumes().size(), 3U);

  EXPECT_THAT(told_after([&] {
                folder.write("r.new", "mine");
                std::filesystem::rename(folder / "r.new", file);
              }),
              AllOf(HasSubstr("another file took its place"), HasSubstr("is lost")));
  EXPECT_EQ(tests::whole_file(file), "mine");

  EXPECT_THAT(told_after([&] {
                std::filesystem::create_hard_link(file, other);
                std::filesystem::remove(file);
              }),
              HasSubstr("has another name"));
  EXPECT_EQ(tests::must(RecordingReader::open(other)).volumes().size(), 3U);
}

TEST_F(Recording, refuses_what_is_none) {
  EXPECT_THAT(refusal(folder / "none.h5"), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("a folder"));
  EXPECT_THAT(refusal(folder.write("empty.h5", "")), HasSubstr("no recording"));
  EXPECT_THAT(refusal(folder.write("text.h5", "NRRD0005\n")),
              AllOf(HasSubstr("no recording"), HasSubstr("signature")));
  const std::string other = folder / "other.h5";
  H5Fclose(H5Fcreate(other.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_THAT(refusal(other), HasSubstr("is no recording of octascope"));
}

TEST_F(Recording, tells_of_volumes_that_were_cut_off_while_it_was_open) {
  write_small_recording(file, 40);
  auto reader = tests::must(RecordingReader::open(file));
  Volume volume{reader.facts().geometry};
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5'000);
  int unread = 0;
  for (std::size_t n = 0; n < 40; ++n) {
    const auto read = reader.read(n, volume);
    if (read) {
      EXPECT_EQ(volume.levels, small_recording_volume(n).levels) << n;
    } else {
      EXPECT_THAT(read.error().message, HasSubstr("was truncated after it was opened"));
      ++unread;
    }
  }
  EXPECT_GE(unread, 5'000 / 420);
  EXPECT_LT(unread, 40);
}

TEST_F(Recording, refuses_what_was_cut_off) {
  write_small_recording(file, 3);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) * 2 / 3);
  EXPECT_THAT(refusal(file), HasSubstr("truncated"));
}

// Changed by another program, so that all of HDF5's own checks pass.
TEST_F(Recording, refuses_facts_that_cannot_be) {
  const auto with = [&](const char* attribute, std::int64_t value) {
    std::filesystem::remove(file);
    write_small_recording(file, 1);
    const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t found = H5Aopen(opened, attribute, H5P_DEFAULT);
    H5Awrite(found, H5T_NATIVE_INT64, &value);
    H5Aclose(found);
    H5Fclose(opened);
    return refusal(file);
  };
  EXPECT_THAT(with("format_version", 2), HasSubstr("found 2, this program reads 1"));
  EXPECT_THAT(with("depths", 0), HasSubstr("depths: found 0"));
  EXPECT_THAT(with("a_scans", 70'000), HasSubstr("a_scans: found 70000, expected 1 to 65536"));
  EXPECT_THAT(with("b_scans", 6),
              HasSubstr("/levels: found [1, 5, 7, 12] of whole numbers, expected [rows, 6, 7, 12] "
                        "of whole numbers"));
  EXPECT_THAT(with("level_step_db", 1), HasSubstr("level_step_db: found 1, expected 0.5"));
  EXPECT_EQ(with("finished", 1), "");
}

// Whatever bytes a file has: a message, or volumes that are read or refused. In a process of its
// own, since what HDF5 does with such a file is not ours to fix.
TEST_F(Recording, with_damaged_bytes_is_read_or_refused) {
  write_small_recording(file, 3);
  const std::string good = tests::whole_file(file);
  std::mt19937_64 random{tests::fresh_seed()};
  int refused = 0;
  constexpr int rounds = 200;
  for (int round = 0; round < rounds; ++round) {
    const std::string bad = tests::mutate(good, random);
    const auto path = folder / fmt::format("bad-{}.h5", round);
    folder.write(path.filename().string(), bad);
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(20);
      auto reader = RecordingReader::open(path);
      Volume volume{small_recording_facts().geometry};
      bool all = reader.has_value();
      for (std::size_t n = 0; reader && n < reader->volumes().size(); ++n)
        all = reader->read(n, volume).has_value() && all;
      ::_exit(all ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status)) << "round " << round << ", " << status;
    refused += WEXITSTATUS(status);
    std::filesystem::remove(path);
  }
  fmt::print("  {} of {} refused\n", refused, rounds);
  EXPECT_GT(refused, rounds / 20);
}

} // namespace
} // namespace octascope::pipeline
