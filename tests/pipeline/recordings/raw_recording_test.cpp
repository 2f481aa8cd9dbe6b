// Recordings of raw spectra: what was written is read, where it lies; what is damaged is refused.
#include <array>
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pipeline/files/crc32.h"
#include "pipeline/recordings/hdf5/hdf5.h"
#include "pipeline/recordings/raw/frame_places.h"
#include "pipeline/recordings/raw/raw_layout.h"
#include "pipeline/recordings/raw/raw_reader.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/size_limit.h"
#include "tests/support/files/small_raw.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;
using tests::small_raw_facts;
using tests::small_raw_frame;
using tests::small_raw_samples;

constexpr std::uint64_t sweeps = 6; // of a volume

class RawRecordingTest : public testing::Test {
protected:
  RawReader open() { return tests::must(RawReader::open(file)); }
  std::string refusal() {
    const auto reader = RawReader::open(file);
    EXPECT_FALSE(reader);
    return reader ? "" : reader.error().message;
  }

  // That it has so many, of which it got no more than it has.
  void claim(hsize_t frames) const {
    const hal::LineFormat format = small_raw_facts().format;
    const Hdf5Handle opened{H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
    const auto extend = [&](const char* name, const auto& size) {
      const Hdf5Handle dataset{H5Dopen2(opened, name, H5P_DEFAULT), H5Dclose};
      ASSERT_GE(H5Dset_extent(dataset, size.data()), 0) << name;
    };
    extend(raw_layout::spectra, raw_layout::spectra_size(format, frames));
    extend(raw_layout::frames, std::array{frames});
    extend(raw_layout::backgrounds, raw_layout::backgrounds_size(format, frames));
  }

  tests::ScratchFolder folder;
  std::filesystem::path file = folder / "r.h5";
};

TEST_F(RawRecordingTest, says_what_it_was_told) {
  tests::write_small_raw(file, sweeps);
  const auto reader = open();
  const RawFacts& facts = reader.facts();
  const RawFacts written = small_raw_facts();
  EXPECT_EQ(facts.format, written.format);
  EXPECT_EQ(facts.plan, written.plan);
  EXPECT_EQ(facts.recorded_by, written.recorded_by);
  EXPECT_EQ(facts.begun, written.begun);
  EXPECT_EQ(facts.source, written.source);
  EXPECT_TRUE(facts.simulated);
  EXPECT_EQ(facts.subject, written.subject);
  EXPECT_EQ(facts.eye, Eye::left);
  EXPECT_EQ(facts.configuration, written.configuration);
  EXPECT_EQ(facts.path, "fused");
  EXPECT_EQ(facts.isa, "AVX2");
  EXPECT_EQ(facts.calibration.positions, written.calibration.positions);
  EXPECT_EQ(facts.calibration.dispersion_rad, written.calibration.dispersion_rad);
  EXPECT_EQ(facts.calibration.window, written.calibration.window);
  EXPECT_EQ(facts.calibration.background_mode, BackgroundMode::running);
  EXPECT_TRUE(reader.end().finished);
  EXPECT_EQ(reader.end().not_kept, 2U);
  EXPECT_EQ(reader.end().camera, "a camera");
  EXPECT_TRUE(says_raw_spectra(file));
}

TEST_F(RawRecordingTest, hands_out_frames_where_they_lie_in_the_order_of_the_scan) {
  {
    auto writer = tests::must(RawWriter::create(file, small_raw_facts()));
    for (const unsigned n : {7U, 1U, 0U, 3U, 2U, 5U, 4U, 6U, 9U, 8U, 11U, 10U}) // as workers come
      tests::append_small_raw(writer, n);
    ASSERT_TRUE(writer.finish({}));
  }
  const auto reader = open();
  ASSERT_EQ(reader.frames().size(), 2 * sweeps);
  ASSERT_EQ(reader.volumes().size(), 2U);
  EXPECT_TRUE(reader.volumes()[1].whole);
  EXPECT_EQ(reader.volumes()[1].index, 2U);
  const auto kept = tests::must(reader.spectra(0, 2 * sweeps, RawLines::kept));
  const auto all = tests::must(reader.spectra(0, 2 * sweeps, RawLines::all));
  EXPECT_EQ(kept.shape(), (SpectraShape{12, 5, 16}));
  EXPECT_EQ(all.shape(), (SpectraShape{12, 7, 16}));
  const auto backgrounds = tests::must(reader.backgrounds(0, 2 * sweeps));
  for (std::uint64_t n = 0; n < 2 * sweeps; ++n) {
    const auto b = static_cast<int>(n);
    EXPECT_EQ(reader.frames()[n].sequence, n);
    EXPECT_EQ(all.find_fault(b), std::nullopt);
    const auto samples = small_raw_samples(n);
    EXPECT_EQ(std::memcmp(all.b_scan(b).data(), samples.data(), all.b_scan(b).size()), 0);
    EXPECT_EQ(std::memcmp(kept.b_scan(b).data(), samples.data(), kept.b_scan(b).size()), 0);
    EXPECT_EQ(backgrounds[n * 16 + 5], 1000.1F + static_cast<float>(n));
  }
}

TEST_F(RawRecordingTest, of_a_writer_that_went_away_has_what_was_flushed) {
  auto writer = tests::must(RawWriter::create(file, small_raw_facts()));
  for (std::uint64_t n = 0; n < sweeps; ++n)
    tests::append_small_raw(writer, n);
  ASSERT_TRUE(writer.flush());
  const tests::ScratchFolder other; // as the disk has it, while the writer has it open
  std::filesystem::copy_file(file, other / "copy.h5");
  file = other / "copy.h5";
  const auto reader = open();
  EXPECT_FALSE(reader.end().finished);
  EXPECT_EQ(reader.frames().size(), sweeps);
  EXPECT_EQ(tests::must(reader.spectra(0, sweeps, RawLines::kept)).find_fault(5), std::nullopt);
}

TEST_F(RawRecordingTest, whose_disk_refused_to_be_written_has_what_was_flushed) {
  const pid_t child = ::fork();
  if (child == 0) {
    bool failed = false;
    {
      auto writer = RawWriter::create(file, small_raw_facts());
      for (std::uint64_t n = 0; n < 200 && !failed; ++n) {
        const auto samples = small_raw_samples(n);
        failed = !writer->append(small_raw_frame(n), std::as_bytes(std::span{samples}),
                                 tests::small_raw_background(n));
        if (n + 1 == sweeps && writer->flush())
          tests::limit_file_sizes(std::filesystem::file_size(file));
      }
      failed = failed && !writer->finish({});
    }
    ::_exit(failed ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  const auto reader = open();
  EXPECT_FALSE(reader.end().finished);
  ASSERT_GE(reader.frames().size(), sweeps);
  const auto spectra = tests::must(reader.spectra(0, sweeps, RawLines::all));
  for (int b = 0; b < spectra.shape().b_scans; ++b)
    EXPECT_EQ(spectra.find_fault(b), std::nullopt);
}

TEST_F(RawRecordingTest, a_volume_that_lacks_a_sweep_is_told_as_that) {
  {
    auto writer = tests::must(RawWriter::create(file, small_raw_facts()));
    for (const unsigned n : {0U, 1U, 2U, 4U, 5U})
      tests::append_small_raw(writer, n);
    ASSERT_TRUE(writer.finish({}));
  }
  const auto reader = open();
  EXPECT_THAT(reader.whole_volume(0).error().message, HasSubstr("found 5 of its 6 sweeps"));
  EXPECT_THAT(reader.whole_volume(1).error().message, HasSubstr("found 1 of them"));
  EXPECT_THAT(reader.first_whole_volume().error().message, HasSubstr("no volume in it is whole"));
}

TEST_F(RawRecordingTest, a_changed_sample_is_found) {
  tests::write_small_raw(file, sweeps);
  std::string bytes = tests::whole_file(file);
  const auto samples = small_raw_samples(4);
  const std::string_view frame{reinterpret_cast<const char*>(samples.data()), samples.size() * 2};
  const std::size_t place = bytes.find(frame);
  ASSERT_NE(place, std::string::npos);
  EXPECT_EQ(place % 4096, 0U);          // of a page
  bytes[place + frame.size() - 1] ^= 1; // in the fly-back
  folder.write("r.h5", bytes);
  const auto reader = open();
  const auto spectra = tests::must(reader.spectra(0, sweeps, RawLines::kept));
  EXPECT_EQ(spectra.find_fault(3), std::nullopt);
  EXPECT_THAT(spectra.find_fault(4).value_or(""), HasSubstr("is damaged: found the checksum"));
}

TEST_F(RawRecordingTest, writes_over_nothing) {
  folder.write("r.h5", "mine");
  EXPECT_THAT(RawWriter::create(file, small_raw_facts()).error().message,
              HasSubstr("never written over"));
}

TEST_F(RawRecordingTest, refuses_what_holds_no_raw_spectra) {
  folder.write("r.h5", "something else");
  EXPECT_THAT(refusal(), HasSubstr("is no recording"));
  EXPECT_FALSE(is_raw_recording(file));
  EXPECT_FALSE(says_raw_spectra(file));
  EXPECT_THAT(RawReader::open(folder / "none.h5").error().message, HasSubstr("no such file"));
}

// Whatever stands there as a number.
TEST_F(RawRecordingTest, refuses_or_bears_any_number_in_its_attributes) {
  tests::write_small_raw(file, sweeps);
  const std::string good = tests::whole_file(file);
  int refused = 0;
  for (const char* const name :
       {"format_version", "samples", "lines_per_frame", "significant_bits", "right_shift",
        "averaged_lines", "a_scans", "fly_back_lines", "b_scans", "repeats", "bidirectional",
        "turn_around_lines", "finished", "not_kept"})
    for (const std::int64_t value : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{3},
                                     std::int64_t{65536}, std::int64_t{1} << 40}) {
      folder.write("r.h5", good);
      {
        const Hdf5Handle opened{H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
        const Hdf5Handle attribute{H5Aopen(opened, name, H5P_DEFAULT), H5Aclose};
        ASSERT_GE(H5Awrite(attribute, H5T_NATIVE_INT64, &value), 0) << name;
      }
      const auto reader = RawReader::open(file);
      refused += reader ? 0 : 1;
      if (reader && reader->first_whole_volume())
        static_cast<void>(reader->spectra(0, sweeps, RawLines::all));
    }
  EXPECT_GT(refused, 30);
}

// As long as the file's size bears it out: HDF5 gives no room to rows that nobody wrote.
TEST_F(RawRecordingTest, that_claims_frames_which_it_cannot_hold_is_given_no_memory_for_them) {
  tests::write_small_raw(file, sweeps);
  claim(100'000);
  const std::uintmax_t bytes = std::filesystem::file_size(file);
  ASSERT_LT(bytes, 1'000'000U);
  {
    const auto reader = open();
    EXPECT_LE(reader.frames().size(), bytes / small_raw_facts().format.frame_bytes());
    EXPECT_THAT(reader.spectra(0, reader.frames().size(), RawLines::all).error().message,
                HasSubstr("is not there"));
  }
  claim(hsize_t{1} << 40);
  EXPECT_THAT(refusal(), HasSubstr("expected what a file of"));
}

TEST_F(RawRecordingTest, is_not_larger_for_its_holes) {
  tests::write_small_raw(file, sweeps);
  constexpr std::uintmax_t holes = std::uintmax_t{1} << 36;
  std::filesystem::resize_file(file, holes);
  EXPECT_EQ(open().frames().size(), sweeps) << "as long as it claims no more";
  claim(100'000);
  std::filesystem::resize_file(file, holes); // HDF5 left them out
  EXPECT_THAT(refusal(), HasSubstr("the others are holes"));
}

// So that an index is found between frames now and then, and workers finish in any order.
TEST_F(RawRecordingTest, finds_each_of_many_small_frames_where_hdf5_says_it_is) {
  constexpr std::uint64_t frames = 3000;
  {
    auto writer = tests::must(RawWriter::create(file, small_raw_facts()));
    for (std::uint64_t n = 0; n < frames; ++n) {
      const std::uint64_t swapped = n ^ 1U;
      const auto samples = small_raw_samples(swapped);
      ASSERT_TRUE(writer.append(small_raw_frame(swapped), std::as_bytes(std::span{samples}),
                                tests::small_raw_background(swapped)));
    }
    ASSERT_TRUE(writer.finish({}));
  }
  const auto reader = open();
  const auto spectra = tests::must(reader.spectra(0, frames, RawLines::all));
  for (std::uint64_t n = 0; n < frames; ++n) {
    const auto expected = small_raw_samples(n);
    const auto found = spectra.b_scan(static_cast<int>(n));
    ASSERT_EQ(spectra.find_fault(static_cast<int>(n)), std::nullopt);
    ASSERT_EQ(std::memcmp(found.data(), expected.data(), found.size()), 0) << n;
  }
}

// How often HDF5 has to be asked, who counts frames from the first for each.
TEST_F(RawRecordingTest, asks_hdf5_for_few_of_many_small_frames) {
  constexpr std::size_t frames = 5000;
  std::vector<std::uint32_t> checksums;
  {
    auto writer = tests::must(RawWriter::create(file, small_raw_facts()));
    for (std::uint64_t n = 0; n < frames; ++n) {
      const auto samples = small_raw_samples(n);
      checksums.push_back(crc32_of(std::as_bytes(std::span{samples})));
      ASSERT_TRUE(writer.append(small_raw_frame(n), std::as_bytes(std::span{samples}),
                                tests::small_raw_background(n)));
    }
    ASSERT_TRUE(writer.finish({}));
  }
  const Hdf5Handle opened{H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  const Hdf5Handle dataset{H5Dopen2(opened, raw_layout::spectra, H5P_DEFAULT), H5Dclose};
  auto places =
      tests::must(FramePlaces::open(file, dataset, small_raw_facts().format.frame_bytes()));
  for (std::size_t n = 0; n < frames; ++n)
    ASSERT_TRUE(places.find(n, checksums[n])) << n;
  EXPECT_LT(places.asked(), frames / 50);
}

// Chunks that another program made.
TEST_F(RawRecordingTest, refuses_packed_frames_and_says_how_to_unpack_them) {
  tests::write_small_raw(file, 0);
  {
    const Hdf5Handle opened{H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
    ASSERT_GE(H5Ldelete(opened, raw_layout::spectra, H5P_DEFAULT), 0);
    const auto size = raw_layout::spectra_size(small_raw_facts().format, 1);
    const Hdf5Handle space{H5Screate_simple(3, size.data(), nullptr), H5Sclose};
    const Hdf5Handle made{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_chunk(made, 3, size.data());
    H5Pset_deflate(made, 1);
    const Hdf5Handle packed{H5Dcreate2(opened, raw_layout::spectra, H5T_STD_U16LE, space,
                                       H5P_DEFAULT, made, H5P_DEFAULT),
                            H5Dclose};
    ASSERT_TRUE(packed.valid());
  }
  EXPECT_THAT(refusal(), HasSubstr("h5repack -f NONE -l CHUNK=1x7x16"));
}

class DamagedRawRecording : public RawRecordingTest {
protected:
  void read_all() const {
    const auto reader = RawReader::open(file);
    if (!reader) {
      EXPECT_THAT(reader.error().message, HasSubstr("r.h5: "));
      return;
    }
    const auto spectra = reader->spectra(0, reader->frames().size(), RawLines::all);
    static_cast<void>(reader->backgrounds(0, reader->frames().size()));
    for (int b = 0; spectra && b < spectra->shape().b_scans; ++b)
      static_cast<void>(spectra->find_fault(b));
  }
};

TEST_F(DamagedRawRecording, cut_off_or_changed_anywhere_it_is_read_or_refused) {
  tests::write_small_raw(file, 2 * sweeps);
  const std::string good = tests::whole_file(file);
  std::mt19937_64 random{tests::fresh_seed()};
  for (int round = 0; round < 200; ++round) {
    std::string bad = good;
    if (round % 2 == 0)
      bad.resize(random() % bad.size());
    for (int i = 0; i < round % 3 && !bad.empty(); ++i)
      bad[random() % bad.size()] = static_cast<char>(random());
    folder.write("r.h5", bad);
    read_all();
    EXPECT_EQ(H5Fget_obj_count(hid_t{H5F_OBJ_ALL}, H5F_OBJ_ALL), 0) << "something was left open";
  }
}

} // namespace
} // namespace octascope::pipeline
