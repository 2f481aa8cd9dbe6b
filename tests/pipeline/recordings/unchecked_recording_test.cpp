// Damage that passes HDF5's checksums, as in a file that somebody made up: whatever HDF5 does with it
// happens in a process of its own, and the program goes on.
//
// In this program every checksum is the same number (--wrap in CMakeLists.txt), so that each damaged
// byte gets as far as HDF5's decoders.
#include <cstdlib>
#include <functional>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pipeline/recordings/raw/raw_reader.h"
#include "pipeline/recordings/recording_reader.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_raw.h"
#include "tests/support/files/small_recording.h"

extern "C" std::uint32_t __wrap_H5_checksum_metadata(const void*, std::size_t, std::uint32_t) {
  return 0x53554D21;
}

namespace octascope::pipeline {
namespace {

enum class End { read, refused, crashed_in_trial };

// How `read` ended, in a process of its own.
End ends_apart(const std::function<End()>& read) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);
    ::_exit(static_cast<int>(read()));
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
  return static_cast<End>(WEXITSTATUS(status));
}

End end_of_refusal(const hal::Error& error) {
  return error.message.find("HDF5 crashes on it") == std::string::npos ? End::refused
                                                                       : End::crashed_in_trial;
}

// The file is opened and every volume read.

End read_apart(const std::filesystem::path& file) {
  return ends_apart([&] {
    auto reader = RecordingReader::open(file);
    if (!reader)
      return end_of_refusal(reader.error());
    Volume volume{reader->facts().geometry};
    bool all = true;
    for (std::size_t n = 0; n < reader->volumes().size(); ++n)
      all = reader->read(n, volume).has_value() && all;
    return all ? End::read : End::refused;
  });
}

// Likewise every frame.
End read_raw_apart(const std::filesystem::path& file) {
  return ends_apart([&] {
    const auto reader = RawReader::open(file);
    if (!reader)
      return end_of_refusal(reader.error());
    const auto spectra = reader->spectra(0, reader->frames().size(), RawLines::all);
    bool all = reader->backgrounds(0, reader->frames().size()).has_value() && spectra.has_value();
    for (int b = 0; spectra && b < spectra->shape().b_scans; ++b)
      all = !spectra->find_fault(b) && all;
    return all ? End::read : End::refused;
  });
}

// OCTASCOPE_TEST_ROUNDS: so many, for a long run by hand.
int rounds() {
  const char* const wanted = std::getenv("OCTASCOPE_TEST_ROUNDS");
  return wanted == nullptr ? 300 : std::atoi(wanted);
}

// Of the good file in that folder.
void damage_and_read(const tests::ScratchFolder& folder,
                     const std::function<End(const std::filesystem::path&)>& read_apart) {
  const std::filesystem::path file = folder / "r.h5";
  const std::string good = tests::whole_file(file);
  ASSERT_EQ(read_apart(file), End::read);
  // Most of the file is zeros, for volumes to come: what HDF5 decodes is what is changed.
  std::vector<std::size_t> written;
  for (std::size_t at = 0; at < good.size(); ++at)
    if (good[at] != '\0' || (at > 0 && good[at - 1] != '\0'))
      written.push_back(at);
  std::mt19937_64 random{tests::fresh_seed()};
  int ends[3] = {};
  for (int round = 0; round < rounds(); ++round) {
    std::string bad = good;
    constexpr unsigned char awkward[] = {0x00, 0x01, 0x7F, 0x80, 0xFF};
    for (std::size_t i = 0; i < 1 + random() % 3; ++i)
      bad[written[random() % written.size()]] =
          static_cast<char>(random() % 2 == 0 ? random() : awkward[random() % std::size(awkward)]);
    folder.write("r.h5", bad);
    const End end = read_apart(file);
    ++ends[static_cast<int>(end)];
    if (testing::Test::HasFailure()) {
      std::filesystem::copy_file(file, "/tmp/unchecked_recording.h5",
                                 std::filesystem::copy_options::overwrite_existing);
      FAIL() << "in round " << round << "; the file is in /tmp/unchecked_recording.h5";
    }
  }
  fmt::print("  {} read, {} refused, {} crashed HDF5 in its trial\n", ends[0], ends[1], ends[2]);
  EXPECT_GT(ends[1], 0);
}

TEST(UncheckedRecording, is_read_or_refused_and_crashes_nobody) {
  const tests::ScratchFolder folder;
  tests::write_small_recording(folder / "r.h5", 3);
  damage_and_read(folder, read_apart);
}

TEST(UncheckedRecording, of_raw_spectra_is_read_or_refused_and_crashes_nobody) {
  const tests::ScratchFolder folder;
  tests::write_small_raw(folder / "r.h5", 12);
  damage_and_read(folder, read_raw_apart);
}

} // namespace
} // namespace octascope::pipeline
