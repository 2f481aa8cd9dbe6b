// Recordings that another program has changed, holds open, or made up: read alike, or refused with
// the true reason.
#include <functional>
#include <random>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pipeline/recordings/hdf5/hdf5.h"
#include "pipeline/recordings/recording_reader.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_recording.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using hal::ErrorCode;
using testing::HasSubstr;
using tests::FailsWith;
using tests::write_small_recording;

// A text as HDF5 may hold it.
struct TextForm {
  bool variable = false;
  H5T_str_t padding = H5T_STR_NULLTERM;
  H5T_cset_t characters = H5T_CSET_UTF8;
  std::size_t more = 0; // bytes of fixed length beyond the text's
  bool in_a_row = false;
};

constexpr TextForm variable_text{.variable = true};

class ChangedRecording : public testing::Test {
protected:
  void SetUp() override { write_small_recording(file, 2); }

  // Does something to the file as a program does that uses HDF5.
  void change(const std::function<void(hid_t)>& action) {
    const Hdf5Handle opened{H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
    ASSERT_TRUE(opened.valid());
    const Hdf5Silence silence;
    action(opened);
  }
  void put(const char* name, hid_t type, const void* value, hsize_t count = 0) {
    change([&](hid_t opened) {
      H5Adelete(opened, name);
      const Hdf5Handle space{
          count == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose};
      const Hdf5Handle attribute{H5Acreate2(opened, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                                 H5Aclose};
      ASSERT_TRUE(attribute.valid()) << name;
      ASSERT_GE(H5Awrite(attribute, type, value), 0) << name;
    });
  }
  void put_text(const char* name, std::string text, const TextForm& form) {
    const Hdf5Handle type{H5Tcopy(H5T_C_S1), H5Tclose};
    H5Tset_cset(type, form.characters);
    H5Tset_strpad(type, form.padding);
    H5Tset_size(type, form.variable ? H5T_VARIABLE : text.size() + form.more);
    text.resize(text.size() + form.more, form.padding == H5T_STR_SPACEPAD ? ' ' : '\0');
    const char* const start = text.c_str();
    put(name, type, form.variable ? static_cast<const void*>(&start) : start,
        form.in_a_row ? 1 : 0);
  }
  // All of it, as info and export do.
  hal::Result<> read_all() const {
    HAL_TRY(auto reader, RecordingReader::open(file));
    Volume volume{reader.facts().geometry};
    for (std::size_t n = 0; n < reader.volumes().size(); ++n)
      HAL_CHECK(reader.read(n, volume));
    return {};
  }
  RecordingFacts facts() const { return tests::must(RecordingReader::open(file)).facts(); }

  // In a process of its own, of little memory: 0 read, 1 refused.
  int read_apart(rlim_t most_memory = std::size_t{512} << 20) {
    const pid_t child = ::fork();
    if (child == 0) {
#ifndef OCTASCOPE_SANITIZED
      const rlimit memory{most_memory, most_memory};
      ::setrlimit(RLIMIT_AS, &memory);
#else
      static_cast<void>(most_memory);
#endif
      ::alarm(20);
      ::_exit(read_all() ? 0 : 1);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  tests::ScratchFolder folder;
  const std::filesystem::path file = folder / "r.h5";
};

TEST_F(ChangedRecording, has_the_same_text_in_every_form) {
  const std::string long_text(10'000, 'x');
  for (const std::string& text : {std::string{"Jürgen Größe 山田"}, std::string{"17"}, long_text})
    for (const TextForm& form :
         {variable_text, TextForm{.variable = true, .characters = H5T_CSET_ASCII},
          TextForm{.variable = true, .in_a_row = true}, TextForm{.more = 1},
          TextForm{.characters = H5T_CSET_ASCII, .more = 20}, TextForm{.padding = H5T_STR_NULLPAD},
          TextForm{.padding = H5T_STR_NULLPAD, .more = 9},
          TextForm{.padding = H5T_STR_SPACEPAD, .more = 7},
          TextForm{.padding = H5T_STR_SPACEPAD, .more = 7, .in_a_row = true}}) {
      put_text("subject", text, form);
      EXPECT_EQ(facts().subject, text) << form.variable << form.padding << form.more;
    }
  put_text("subject", "", variable_text);
  EXPECT_EQ(facts().subject, "");
}

TEST_F(ChangedRecording, may_hold_each_of_its_texts_in_variable_length) {
  const RecordingFacts before = facts();
  put_text("format", "octascope recording", variable_text);
  put_text("recorded_by", "b", variable_text);
  put_text("begun", before.begun, variable_text);
  put_text("source", "s", variable_text);
  put_text("eye", "right", variable_text);
  put_text("configuration", "[scan]\n", variable_text);
  const RecordingFacts after = facts();
  EXPECT_EQ(after.recorded_by, "b");
  EXPECT_EQ(after.begun, before.begun);
  EXPECT_EQ(after.source, "s");
  EXPECT_EQ(after.eye, Eye::right);
  EXPECT_EQ(after.configuration, "[scan]\n");
}

TEST_F(ChangedRecording, may_hold_its_numbers_in_other_types) {
  const std::int8_t yes = 1;
  const Hdf5Handle truth{H5Tenum_create(H5T_NATIVE_INT8), H5Tclose};
  H5Tenum_insert(truth, "TRUE", &yes);
  put("simulated", truth, &yes);
  const int spacing_um = 4;
  put("a_spacing_um", H5T_NATIVE_INT, &spacing_um);
  const std::uint16_t depths = 12;
  put("depths", H5T_NATIVE_UINT16, &depths);
  const RecordingFacts found = tests::must(RecordingReader::open(file)).facts();
  EXPECT_TRUE(found.simulated);
  EXPECT_EQ(found.geometry.a_spacing_um, 4);
}

TEST_F(ChangedRecording, with_a_text_that_is_too_long_is_refused) {
  for (const bool variable : {true, false}) {
    put_text("source", std::string(3'000'000, 'x'), {.variable = variable});
    EXPECT_THAT(RecordingReader::open(file),
                FailsWith(ErrorCode::bad_data, file.string(), "attribute source",
                          "found a text of 3000000 bytes, expected at most 1048576"));
  }
}

TEST_F(ChangedRecording, of_nothing_but_a_foreign_format_is_none) {
  put_text("format", "another", variable_text);
  EXPECT_THAT(RecordingReader::open(file),
              FailsWith(ErrorCode::bad_data, "is no recording of octascope", "\"another\""));
  change([](hid_t opened) { H5Adelete(opened, "format"); });
  EXPECT_THAT(RecordingReader::open(file),
              FailsWith(ErrorCode::bad_data, "is no recording of octascope", "found none"));
}

// Where nothing is checked by a sum, in a file of the oldest version, the length says what it will.
TEST_F(ChangedRecording, whose_text_lies_about_its_length_is_refused) {
  std::filesystem::remove(file);
  {
    const Hdf5Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
    H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
    const Hdf5Handle made{H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access), H5Fclose};
    ASSERT_TRUE(made.valid());
  }
  put_text("format", "octascope recording", variable_text);
  const std::string good = tests::whole_file(file);
  const std::size_t heap = good.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  std::string place(8, '\0');
  for (std::size_t i = 0; i < 8; ++i)
    place[i] = static_cast<char>(heap >> (8 * i));
  const std::size_t reference = good.find(std::string("\x13\0\0\0", 4) + place);
  ASSERT_NE(reference, std::string::npos);
  const auto with = [&](std::size_t at, std::string_view bytes) {
    std::string bad = good;
    bad.replace(at, bytes.size(), bytes);
    folder.write("r.h5", bad);
    return RecordingReader::open(file);
  };
  using namespace std::string_view_literals;
  EXPECT_THAT(with(reference, "\xF0\xFF\xFF\xFF"sv),
              FailsWith(ErrorCode::bad_data, "found a text of 4294967280 bytes"));
  const std::size_t object = heap + 16;
  for (const auto& [at, bytes] : {std::pair{reference, "\0\0\x10\0"sv},       // longer than it is
                                  {reference + 4, "\xFF\xFF\xFF\xFF"sv},      // outside the file
                                  {reference + 12, "\x07\0\0\0"sv},           // no such object
                                  {object + 8, "\x02"sv},                     // shorter
                                  {object + 8, "\xFF\xFF\xFF\xFF\xFF\xFF"sv}, // of all memory
                                  {heap, "KOHL"sv},                           // no heap
                                  {heap + 8, "\xFF\xFF\xFF\xFF\xFF\xFF\xFF"sv}}) // of any size
    EXPECT_THAT(with(at, bytes), FailsWith(ErrorCode::bad_data, "text of variable length"))
        << at << " " << bytes.size();
  EXPECT_THAT(with(heap, "GCOL"sv), FailsWith(ErrorCode::bad_data, "format_version"));
}

TEST_F(ChangedRecording, that_another_program_has_locked_is_not_called_damaged) {
  const int other = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  EXPECT_THAT(RecordingReader::open(file),
              FailsWith(ErrorCode::busy, file.string(), "locked by another program", "close"));
  ASSERT_EQ(::flock(other, LOCK_SH), 0);
  EXPECT_TRUE(read_all()) << "others that read disturb nobody";
  ::close(other);
}

TEST_F(ChangedRecording, that_a_crashed_program_left_open_is_told_with_its_remedy) {
  const pid_t child = ::fork();
  if (child == 0) {
    static_cast<void>(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    ::_exit(0);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_THAT(RecordingReader::open(file), FailsWith(ErrorCode::busy, "marked as open",
                                                     "h5clear -s " + file.string(), "hdf5-tools"));
  // What h5clear does.
  const Hdf5Handle access{H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  const hbool_t clear = 1;
  ASSERT_GE(H5Pset(access, "clear_status_flags", &clear), 0);
  H5Fclose(H5Fopen(file.c_str(), H5F_ACC_RDWR, access));
  EXPECT_TRUE(read_all());
}

TEST_F(ChangedRecording, that_is_a_pipe_is_refused_at_once) {
  std::filesystem::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(RecordingReader::open(file), FailsWith(ErrorCode::invalid_argument, "a pipe"));
}

// Every attribute, with each kind of value that another program may put there.
TEST_F(ChangedRecording, with_any_other_attribute_is_read_or_refused) {
  std::set<std::string> names;
  change([&](hid_t opened) {
    hsize_t at = 0;
    H5Aiterate2(
        opened, H5_INDEX_NAME, H5_ITER_INC, &at,
        [](hid_t, const char* name, const H5A_info_t*, void* all) -> herr_t {
          static_cast<std::set<std::string>*>(all)->insert(name);
          return 0;
        },
        &names);
  });
  ASSERT_GT(names.size(), 15U);
  const std::string good = tests::whole_file(file);
  const std::int64_t numbers[] = {-1, 0, std::numeric_limits<std::int64_t>::max(), 1};
  const double reals[] = {std::nan(""), HUGE_VAL, -1e308, 1e-320};
  const hvl_t row{3, const_cast<std::int64_t*>(numbers)};
  const Hdf5Handle rows{H5Tvlen_create(H5T_NATIVE_INT64), H5Tclose};
  const hsize_t two = 2;
  const Hdf5Handle pairs{H5Tarray_create2(H5T_NATIVE_INT64, 1, &two), H5Tclose};
  const Hdf5Handle record{H5Tcreate(H5T_COMPOUND, 8), H5Tclose};
  H5Tinsert(record, "index", 0, H5T_NATIVE_INT64);
  const Hdf5Handle bytes{H5Tcreate(H5T_OPAQUE, 16), H5Tclose};
  int refused = 0;
  int all = 0;
  const auto with = [&](const std::function<void()>& spoil) {
    folder.write("r.h5", good);
    spoil();
    ++all;
    refused += read_apart();
  };
  for (const std::string& each : names) {
    const char* const name = each.c_str();
    SCOPED_TRACE(name);
    for (const std::int64_t& number : numbers)
      with([&] { put(name, H5T_NATIVE_INT64, &number); });
    for (const double& real : reals)
      with([&] { put(name, H5T_NATIVE_DOUBLE, &real); });
    with([&] { put(name, H5T_NATIVE_INT64, numbers, 3); });
    with([&] { put(name, rows, &row); });
    with([&] { put(name, pairs, numbers); });
    with([&] { put(name, record, numbers); });
    with([&] { put(name, bytes, numbers); });
    with([&] { put_text(name, "\xFF\x1B[2J\n", variable_text); });
    with([&] { put_text(name, std::string(2'000'000, 'y'), {.more = 1}); });
    with([&] {
      change([&](hid_t opened) {
        H5Adelete(opened, name);
        const Hdf5Handle space{H5Screate(H5S_NULL), H5Sclose};
        H5Aclose(H5Acreate2(opened, name, H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT));
      });
    });
    with([&] { change([&](hid_t opened) { H5Adelete(opened, name); }); });
  }
  fmt::print("  {} of {} refused\n", refused, all);
  EXPECT_GT(refused, all * 3 / 4);
}

// What a dataset claims is made up; nothing is in it.
TEST_F(ChangedRecording, with_any_other_dataset_is_refused) {
  const std::string good = tests::whole_file(file);
  const auto with = [&](const char* name, const std::function<void(hid_t)>& make) {
    folder.write("r.h5", good);
    change([&](hid_t opened) {
      H5Ldelete(opened, name, H5P_DEFAULT);
      make(opened);
    });
    EXPECT_EQ(read_apart(), 1) << name;
    return tests::error_of(RecordingReader::open(file)).message;
  };
  const auto dataset = [](const char* name, hid_t type, std::vector<hsize_t> sizes,
                          std::vector<hsize_t> chunk) {
    return [=](hid_t opened) {
      const int rank = static_cast<int>(sizes.size());
      const std::vector<hsize_t> most(sizes.size(), H5S_UNLIMITED);
      const Hdf5Handle made{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
      if (!chunk.empty())
        H5Pset_chunk(made, rank, chunk.data());
      const Hdf5Handle space{
          rank == 0 ? H5Screate(H5S_SCALAR)
                    : H5Screate_simple(rank, sizes.data(), chunk.empty() ? nullptr : most.data()),
          H5Sclose};
      H5Dclose(H5Dcreate2(opened, name, type, space, H5P_DEFAULT, made, H5P_DEFAULT));
    };
  };
  const Hdf5Handle text{H5Tcopy(H5T_C_S1), H5Tclose};
  H5Tset_size(text, H5T_VARIABLE);
  const Hdf5Handle partial{H5Tcreate(H5T_COMPOUND, 16), H5Tclose};
  H5Tinsert(partial, "index", 0, H5T_NATIVE_UINT64);
  H5Tinsert(partial, "first_line_ns", 8, H5T_NATIVE_INT64);
  for (const char* name : {"levels", "b_scan_states", "ledger"}) {
    SCOPED_TRACE(name);
    EXPECT_THAT(with(name, [](hid_t) {}), HasSubstr("found no dataset"));
    with(name, [&](hid_t opened) {
      H5Gclose(H5Gcreate2(opened, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    });
    with(name, [&](hid_t opened) { H5Lcreate_soft(name, opened, name, H5P_DEFAULT, H5P_DEFAULT); });
    with(name, dataset(name, H5T_NATIVE_UINT8, {}, {}));
    with(name, dataset(name, text, {2}, {1}));
    with(name, dataset(name, H5T_NATIVE_DOUBLE, {2, 5, 7, 12}, {1, 5, 7, 12}));
    with(name, dataset(name, H5T_NATIVE_UINT8, {2, 2, 2, 2, 2}, {1, 1, 1, 1, 1}));
  }
  EXPECT_THAT(with("ledger", dataset("ledger", partial, {2}, {1})),
              HasSubstr("found no numbers named last_line_ns"));
  EXPECT_THAT(
      with("levels", dataset("levels", H5T_NATIVE_UINT8, {400'000'000, 5, 7, 12}, {1, 5, 7, 12})),
      HasSubstr("/levels: found 1.68e+11 bytes"));
  EXPECT_THAT(
      with("levels", dataset("levels", H5T_NATIVE_UINT8, {2, 5, 7, 12}, {1, 1'000, 1'000, 4'000})),
      HasSubstr("/levels: found 4e+09 bytes"));
}

// Volumes of any size that a few attributes make up.
TEST_F(ChangedRecording, that_claims_more_than_it_can_hold_takes_no_memory) {
  const std::int64_t many = 65'536;
  for (const char* name : {"depths", "a_scans"})
    put(name, H5T_NATIVE_INT64, &many);
  change([&](hid_t opened) {
    H5Ldelete(opened, "levels", H5P_DEFAULT);
    const hsize_t sizes[] = {2, 5, 65'536, 65'536};
    const hsize_t chunk[] = {1, 1, 64, 64};
    const Hdf5Handle made{H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_chunk(made, 4, chunk);
    const Hdf5Handle space{H5Screate_simple(4, sizes, nullptr), H5Sclose};
    H5Dclose(H5Dcreate2(opened, "levels", H5T_STD_U8LE, space, H5P_DEFAULT, made, H5P_DEFAULT));
  });
  EXPECT_EQ(read_apart(), 1);
  EXPECT_THAT(RecordingReader::open(file), FailsWith(ErrorCode::bad_data, "bytes can hold"));
}

// Texts of variable length lie where HDF5 keeps no sums: the file is changed there alone.
TEST_F(ChangedRecording, with_damage_in_its_texts_is_read_or_refused) {
  put_text("subject", "Jürgen", variable_text);
  put_text("source", std::string(6'000, 's'), variable_text);
  put_text("configuration", std::string(300, 'c'), variable_text);
  const std::string good = tests::whole_file(file);
  const std::size_t heap = good.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  std::mt19937_64 random{tests::fresh_seed()};
  int refused = 0;
  constexpr int rounds = 300;
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE(round);
    std::string bad = good;
    const std::size_t reach = round % 2 == 0 ? 200 : bad.size() - heap; // its heads, or all of it
    for (std::size_t i = 0; i < 1 + random() % 6; ++i)
      bad[heap + random() % reach] = static_cast<char>(random());
    folder.write("r.h5", bad);
    refused += read_apart();
  }
  fmt::print("  {} of {} refused\n", refused, rounds);
  EXPECT_GT(refused, rounds / 20);
}

} // namespace
} // namespace octascope::pipeline
