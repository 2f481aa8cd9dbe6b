// octascope export as a user runs it: every format against the recording's own levels.
#include <algorithm>
#include <cmath>

#include "dcmtk/config/osconfig.h"
#include "dcmtk/dcmdata/dctk.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "pipeline/volume/level_scale.h"
#include "tests/program/program_support.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/small_recording.h"
#include "tests/support/must.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using pipeline::level_db;
using pipeline::Volume;
using pipeline::VolumeGeometry;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

class Export : public testing::Test {
protected:
  void SetUp() override { write_small_recording(recording, 5); }

  Words words(const Words& more) const {
    Words all{"export", recording};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ProgramResult run(const Words& more) const { return run_octascope(words(more), 60s); }
  // What it says on stdout.
  std::string done(const Words& more) {
    const ProgramResult result = run(more);
    EXPECT_EQ(result.exit_status, 0) << result.describe();
    return result.out;
  }
  std::string refused(const Words& more, int exit_status) const {
    return run_refused(folder, words(more), exit_status);
  }

  ScratchFolder folder;
  const std::string recording = folder / "r.h5";
  const std::string out = folder / "out";
};

// Names of all that lies in a folder, in order.
Words files_in(const std::filesystem::path& where) {
  Words names;
  for (const std::string& path : listing(where))
    names.push_back(std::filesystem::path{path}.filename());
  return names;
}

void expect_owner_only(const std::filesystem::path& file) {
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(file).permissions(), perms::owner_read | perms::owner_write)
      << file;
}

std::vector<float> decibels_of(const Volume& volume) {
  std::vector<float> levels;
  for (const std::uint8_t count : volume.levels)
    levels.push_back(-40.0F + 0.5F * count);
  return levels;
}

void expect_geometry(const VolumeGeometry& found) {
  const VolumeGeometry expected = small_recording_facts().geometry;
  EXPECT_EQ(found.depths, expected.depths);
  EXPECT_EQ(found.a_scans, expected.a_scans);
  EXPECT_EQ(found.b_scans, expected.b_scans);
  EXPECT_NEAR(found.depth_spacing_um, expected.depth_spacing_um, 1e-9);
  EXPECT_NEAR(found.a_spacing_um, expected.a_spacing_um, 1e-9);
  EXPECT_NEAR(found.b_spacing_um, expected.b_spacing_um, 1e-9);
}

TEST_F(Export, to_nrrd_holds_every_level_in_decibels) {
  const std::string told = done({"--to", "nrrd", "--out", out});
  EXPECT_THAT(told, HasSubstr("volume-0000.nrrd to volume-0004.nrrd: 5 volumes\n"));
  EXPECT_THAT(told, HasSubstr("SIMULATED"));
  EXPECT_THAT(files_in(out), ElementsAre("volume-0000.nrrd", "volume-0001.nrrd", "volume-0002.nrrd",
                                         "volume-0003.nrrd", "volume-0004.nrrd"));
  for (std::uint64_t n = 0; n < 5; ++n) {
    const std::filesystem::path file = fmt::format("{}/volume-{:04}.nrrd", out, n);
    const auto read = pipeline::read_nrrd(file);
    ASSERT_TRUE(read) << read.error().message;
    expect_geometry(read->geometry);
    EXPECT_EQ(std::get<std::vector<float>>(read->levels), decibels_of(small_recording_volume(n)));
    expect_owner_only(file);
  }
}

TEST_F(Export, to_nrrd_says_in_the_header_what_it_is) {
  done({"--out", folder / "v.nrrd", "--volumes", "2"});
  const std::string file = whole_file(folder / "v.nrrd");
  const std::string header = file.substr(0, file.find("\n\n"));
  for (const char* line :
       {"SIMULATED:=yes, some or all of it is not the patient's", "volume:=2", "index:=4",
        "recording_begun:=2026-11-22T12:10:03+01:00", "wall_clock_ns:=1795345803282000000",
        "source:=phantom eye", "subject:=Müller, 17", "eye:=left", "missing_b_scans:=1",
        "recorded_by:=octascope, in a test"})
    EXPECT_THAT(header, HasSubstr(std::string{"\n"} + line));
  done({"--out", folder / "v.nrrd", "--volumes", "2", "--subject", ""});
  EXPECT_THAT(whole_file(folder / "v.nrrd"), Not(HasSubstr("subject:=")));
}

TEST_F(Export, to_nrrd_of_8_bits_holds_the_counts) {
  done({"--out", folder / "v.nrrd", "--volumes", "3", "--u8"});
  const auto read = pipeline::read_nrrd(folder / "v.nrrd");
  ASSERT_TRUE(read) << read.error().message;
  expect_geometry(read->geometry);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(read->levels), small_recording_volume(3).levels);
}

TEST_F(Export, says_which_spacings_are_assumed) {
  pipeline::RecordingFacts facts = small_recording_facts();
  facts.geometry.assumed = {.depth = true, .a_scans = false, .b_scans = true};
  const std::string assumed = folder / "assumed.h5";
  auto writer = must(pipeline::RecordingWriter::create(assumed, facts));
  Volume volume = small_recording_volume(0);
  volume.geometry = facts.geometry;
  ASSERT_TRUE(writer.append(volume, small_recording_entry(0)));
  ASSERT_TRUE(writer.finish({}));
  const auto said = [&](const char* name) {
    const ProgramResult result =
        run_well({"export", assumed, "--volumes", "0", "--out", folder / name});
    EXPECT_THAT(result.err, HasSubstr("assumed, not measured: depth, B-scan"));
    return whole_file(folder / name);
  };
  EXPECT_THAT(said("v.nrrd"), HasSubstr("\nassumed_spacings:=depth, B-scan\n"));
  EXPECT_THAT(said("v.dcm"), HasSubstr("Spacings that are assumed, not measured: depth, B-scan."));
  EXPECT_THAT(run_well({"info", assumed}).out, HasSubstr("the spacings of depth, B-scan"));
  EXPECT_THAT(run_well({"render", "--volume", assumed, "--out", folder / "v.png"}).err,
              HasSubstr("assumed.h5: its spacings are assumed, not measured: depth, B-scan"));
  EXPECT_THAT(run_well({"replay", assumed, "--display", "offscreen", "--once"}).err,
              HasSubstr("assumed, not measured: depth, B-scan"));
  EXPECT_THAT(run({"--volumes", "0", "--out", folder / "v.nrrd"}).err, Not(HasSubstr("assumed")));
}

TEST_F(Export, takes_the_volumes_that_are_asked_for) {
  EXPECT_THAT(done({"--to", "nrrd", "--out", out, "--volumes", "1-2"}), HasSubstr("2 volumes"));
  EXPECT_THAT(files_in(out), ElementsAre("volume-0001.nrrd", "volume-0002.nrrd"));
  done({"--to", "nrrd", "--out", out, "--volumes", "3-"}); // into the folder that is there now
  done({"--to", "nrrd", "--out", out, "--volume", "0"});
  EXPECT_THAT(files_in(out), ElementsAre("volume-0000.nrrd", "volume-0001.nrrd", "volume-0002.nrrd",
                                         "volume-0003.nrrd", "volume-0004.nrrd"));
  const auto read = pipeline::read_nrrd(folder / "out/volume-0003.nrrd");
  ASSERT_TRUE(read);
  EXPECT_EQ(std::get<std::vector<float>>(read->levels), decibels_of(small_recording_volume(3)));
}

TEST_F(Export, replaces_what_had_the_name) {
  folder.write("v.nrrd", "something else");
  done({"--out", folder / "v.nrrd", "--volumes", "0"});
  EXPECT_TRUE(pipeline::read_nrrd(folder / "v.nrrd"));
  expect_owner_only(folder / "v.nrrd");
}

TEST_F(Export, warns_of_missing_b_scans) {
  const ProgramResult result = run({"--to", "nrrd", "--out", out, "--volumes", "0-2"});
  EXPECT_THAT(result.err, HasSubstr("3 B-scans are missing"));
}

// The values of an element of a DICOM file, as text.
std::string dicom_text(DcmFileFormat& file, const DcmTagKey& key) {
  OFString value;
  file.getDataset()->findAndGetOFStringArray(key, value, true);
  return value.c_str();
}

TEST_F(Export, to_dicom_holds_every_count) {
  const std::string told = done({"--to", "dicom", "--out", out, "--window", "8,36"});
  EXPECT_THAT(told, HasSubstr("SIMULATED"));
  EXPECT_THAT(told, HasSubstr("black is 8.0 dB, white 44.0 dB"));
  ASSERT_THAT(files_in(out), ElementsAre("volume-0000.dcm", "volume-0001.dcm", "volume-0002.dcm",
                                         "volume-0003.dcm", "volume-0004.dcm"));
  std::string series;
  for (std::uint64_t n = 0; n < 5; ++n) {
    const std::string path = fmt::format("{}/volume-{:04}.dcm", out, n);
    DcmFileFormat file;
    ASSERT_TRUE(file.loadFile(path.c_str()).good()) << path;
    const Uint8* pixels = nullptr;
    ASSERT_TRUE(file.getDataset()->findAndGetUint8Array(DCM_PixelData, pixels).good());
    const Volume volume = small_recording_volume(n);
    const auto [depths, a_scans] = std::pair{volume.geometry.depths, volume.geometry.a_scans};
    for (int b = 0; b < volume.geometry.b_scans; ++b)
      for (int z = 0; z < depths; ++z)
        for (int a = 0; a < a_scans; ++a)
          ASSERT_EQ(pixels[(b * depths + z) * a_scans + a],
                    volume.b_scan(b)[static_cast<std::size_t>(a * depths + z)]);
    EXPECT_EQ(dicom_text(file, DCM_InstanceNumber), std::to_string(n + 1));
    EXPECT_EQ(dicom_text(file, DCM_PatientID), "Müller, 17");
    EXPECT_EQ(dicom_text(file, DCM_PixelSpacing), "0.0035\\0.01");
    EXPECT_EQ(dicom_text(file, DCM_WindowWidth), "73");     // 36 dB of half a dB, and one
    EXPECT_EQ(dicom_text(file, DCM_WindowCenter), "132.5"); // 26 dB, and a half
    EXPECT_THAT(dicom_text(file, DCM_ImageComments), HasSubstr("SIMULATED"));
    const std::string uid = dicom_text(file, DCM_SeriesInstanceUID);
    EXPECT_TRUE(series.empty() || series == uid);
    series = uid;
    expect_owner_only(path);
  }
  // Another day, one volume of it: the same series.
  done({"--out", folder / "v.dcm", "--volumes", "4", "--subject", "A-17"});
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile((folder / "v.dcm").c_str()).good());
  EXPECT_EQ(dicom_text(file, DCM_SeriesInstanceUID), series);
  EXPECT_EQ(dicom_text(file, DCM_PatientID), "A-17");
}

TEST_F(Export, to_dicom_needs_the_dictionary_and_says_so) {
  Words words{"env", "DCMDICTPATH=/nowhere"};
  const Words command = octascope_command({"export", recording, "--to", "dicom", "--out", out});
  words.insert(words.end(), command.begin(), command.end());
  const ProgramResult result = run_program(words, 60s);
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("DCMTK's dictionary cannot be read"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

std::uint8_t grey_of(double db, double lowest_db, double size_db) {
  return static_cast<std::uint8_t>(
      std::lround(255 * std::clamp((db - lowest_db) / size_db, 0.0, 1.0)));
}

TEST_F(Export, to_png_draws_a_b_scan_in_the_window) {
  const std::string told =
      done({"--to", "png", "--out", out, "--bscan", "3", "--window", "-10,60"});
  EXPECT_THAT(told, HasSubstr("black is -10.0 dB, white 50.0 dB"));
  EXPECT_THAT(told, HasSubstr("as stored: pixels of 10 µm across and 3.5 µm down"));
  EXPECT_EQ(files_in(out).front(), "volume-0000-b-scan-0003.png");
  for (std::uint64_t n = 0; n < 5; ++n) {
    const std::string file = fmt::format("{}/volume-{:04}-b-scan-0003.png", out, n);
    const auto image = pipeline::read_png(file);
    ASSERT_TRUE(image) << image.error().message;
    ASSERT_EQ(image->width, 7);
    ASSERT_EQ(image->height, 12);
    ASSERT_EQ(image->channels, 1);
    const Volume volume = small_recording_volume(n);
    for (std::size_t z = 0; z < 12; ++z)
      for (std::size_t a = 0; a < 7; ++a)
        ASSERT_EQ(image->pixels[z * 7 + a],
                  grey_of(-40 + 0.5 * volume.b_scan(3)[a * 12 + z], -10, 60));
    expect_owner_only(file);
  }
}

TEST_F(Export, to_png_to_scale_has_square_pixels) {
  done({"--out", folder / "stored.png", "--volumes", "1", "--bscan", "2", "--window", "0,80"});
  const std::string told = done({"--out", folder / "scaled.png", "--volumes", "1", "--bscan", "2",
                                 "--window", "0,80", "--to-scale"});
  EXPECT_THAT(told, HasSubstr("to scale: square pixels of 3.5 µm"));
  const auto stored = pipeline::read_png(folder / "stored.png");
  const auto scaled = pipeline::read_png(folder / "scaled.png");
  ASSERT_TRUE(stored && scaled);
  ASSERT_EQ(scaled->width, 20); // 7 of 10 µm in 3.5 µm
  ASSERT_EQ(scaled->height, 12);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 20; ++x) {
      const int from = static_cast<int>((x + 0.5) / 20 * 7); // the A-scan at its middle
      EXPECT_EQ(scaled->pixels[static_cast<std::size_t>(y * 20 + x)],
                stored->pixels[static_cast<std::size_t>(y * 7 + from)]);
    }
  }
}

TEST_F(Export, to_png_from_above_shows_the_highest_level_of_each_a_scan) {
  const std::string told =
      done({"--out", folder / "e.png", "--volumes", "1", "--window", "-40,100"});
  EXPECT_THAT(told, HasSubstr("as stored: pixels of 10 µm across and 37.5 µm down"));
  const auto image = pipeline::read_png(folder / "e.png");
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, 7);
  ASSERT_EQ(image->height, 5);
  const Volume volume = small_recording_volume(1);
  for (std::size_t a_scan = 0; a_scan < 35; ++a_scan) {
    const auto levels = std::span{volume.levels}.subspan(a_scan * 12, 12); // thinner than the slab
    const double highest = *std::ranges::max_element(levels);
    EXPECT_NEAR(image->pixels[a_scan], grey_of(-40 + 0.5 * highest, -40, 100), 1) << a_scan;
  }

  // Without a window the contrast is the picture's own: from black, here the missing B-scan's and
  // the darkest one that came, to white.
  done({"--to", "png", "--out", out, "--volumes", "1"});
  const auto own = pipeline::read_png(folder / "out/volume-0001-en-face.png");
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_EQ(*std::ranges::min_element(own->pixels), 0);
  EXPECT_GE(*std::ranges::max_element(own->pixels), 250);
  for (std::size_t i = 0; i < 35; ++i)
    for (std::size_t k = 0; k < 35; ++k)
      EXPECT_TRUE(image->pixels[i] <= image->pixels[k] || own->pixels[i] >= own->pixels[k]);
}

TEST_F(Export, finds_one_window_for_all_pictures) {
  const std::string all = done({"--to", "png", "--out", out, "--bscan", "0"});
  const auto at = all.find("black is ");
  ASSERT_NE(at, std::string::npos) << all;
  const std::string one = done({"--out", folder / "one.png", "--volumes", "0", "--bscan", "0"});
  EXPECT_THAT(one, HasSubstr(all.substr(at, all.find('\n', at) - at)));
  EXPECT_EQ(whole_file(folder / "one.png"), whole_file(folder / "out/volume-0000-b-scan-0000.png"));
}

TEST_F(Export, refuses_wrong_use) {
  struct Case {
    Words arguments;
    Words told;
  };
  std::filesystem::create_directory(folder / "full");
  const std::string v = folder / "v";
  const std::vector<Case> cases{
      {{}, {"--out", "required"}},
      {{"--out", out}, {"--to is missing", "expected nrrd, dicom or png"}},
      {{"--to", "tiff", "--out", out}, {"tiff", "nrrd"}},
      {{"--to", "dicom", "--out", v + ".png", "--volumes", "1"}, {"v.png", "ending with .dcm"}},
      {{"--to", "nrrd", "--out", recording},
       {"r.h5", "is a file that the command reads", "nothing was written"}},
      {{"--out", v + ".nrrd"}, {"v.nrrd", "one file for 5 volumes", "expected a folder"}},
      {{"--to", "nrrd", "--out", out, "--volumes", "5"}, {"volume 5", "has 0 to 4"}},
      {{"--to", "nrrd", "--out", out, "--volumes", "2-9"}, {"volume 9", "has 0 to 4"}},
      {{"--to", "nrrd", "--out", out, "--volumes", "3-2"}, {"\"3-2\"", "10-20"}},
      {{"--to", "nrrd", "--out", out, "--volumes", "some"}, {"\"some\"", "10-20"}},
      {{"--to", "nrrd", "--out", out, "--volumes", "99999999999999999999"}, {"--volumes is"}},
      {{"--to", "png", "--out", out, "--bscan", "5"}, {"--bscan is 5", "expected 0 to 4"}},
      {{"--to", "png", "--out", out, "--bscan", "-1"},
       {"--bscan: found \"-1\"", "expected a number from 0"}},
      {{"--to", "png", "--out", out, "--u8"}, {"--u8 is for --to nrrd only"}},
      {{"--to", "dicom", "--out", out, "--bscan", "1"}, {"--bscan is for --to png only"}},
      {{"--to", "dicom", "--out", out, "--to-scale"}, {"--to-scale is for --to png only"}},
      {{"--to", "nrrd", "--out", out, "--window", "8,36"}, {"--window is for --to dicom"}},
      {{"--to", "png", "--out", out, "--subject", "x"}, {"--subject is for --to nrrd"}},
      {{"--to", "png", "--out", out, "--window", "8"}, {"--window is \"8\"", "8,36"}},
      {{"--to", "dicom", "--out", out, "--subject", "a\\b"}, {"a\\b", "64 characters"}}};
  for (const Case& wrong : cases) {
    const std::string said = refused(wrong.arguments, 2);
    for (const std::string& words : wrong.told)
      EXPECT_THAT(said, HasSubstr(words));
  }
}

TEST_F(Export, says_at_once_what_cannot_be) {
  EXPECT_THAT(refused({"--to", "nrrd", "--out", folder / "no/such"}, 1),
              HasSubstr("the folder cannot be made: No such file"));
  EXPECT_THAT(refused({"--out", folder / "no/such.nrrd", "--volumes", "1"}, 1),
              HasSubstr("no/such.nrrd"));
  std::filesystem::create_directory(folder / "d.nrrd"); // a folder all the same
  done({"--to", "nrrd", "--out", folder / "d.nrrd", "--volumes", "1"});
  EXPECT_THAT(files_in(folder / "d.nrrd"), ElementsAre("volume-0001.nrrd"));
}

TEST_F(Export, finds_a_damaged_or_empty_recording) {
  const std::string whole = whole_file(recording);
  folder.write("r.h5", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(refused({"--to", "nrrd", "--out", out}, 1), HasSubstr("r.h5"));
  folder.write("r.h5", "no recording at all");
  EXPECT_THAT(refused({"--to", "dicom", "--out", out}, 1), HasSubstr("r.h5"));
  std::filesystem::remove(recording);
  EXPECT_THAT(refused({"--to", "png", "--out", out}, 1), HasSubstr("no such file"));
  write_small_recording(recording, 0);
  EXPECT_THAT(refused({"--to", "png", "--out", out}, 1), HasSubstr("found no volumes"));
}

TEST_F(Export, of_one_that_was_never_finished_has_what_is_there) {
  std::filesystem::remove(recording);
  {
    auto writer = pipeline::RecordingWriter::create(recording, small_recording_facts());
    ASSERT_TRUE(writer);
    append_small_volumes(*writer, 0, 3);
  }
  EXPECT_THAT(done({"--to", "nrrd", "--out", out}), HasSubstr("3 volumes"));
}

TEST_F(Export, on_a_full_disk_leaves_nothing_half_written) {
  const Words command = octascope_command({"export", recording, "--to", "nrrd", "--out", out});
  Words words{"bash", "-c", "trap '' XFSZ; ulimit -f 1; exec \"$@\"", "bash"};
  words.insert(words.end(), command.begin(), command.end());
  const ProgramResult result = run_program(words, 60s);
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("volume-0000.nrrd: cannot be written: File too large"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace octascope::tests
