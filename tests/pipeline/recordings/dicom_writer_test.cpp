// Volumes as DICOM files, read back by DCMTK, and looked at by dciodvfy, which knows the standard.
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <set>

#include "dcmtk/config/osconfig.h"
#include "dcmtk/dcmdata/dctk.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "pipeline/recordings/dicom/dicom_text.h"
#include "pipeline/recordings/dicom/dicom_uid.h"
#include "pipeline/recordings/dicom/dicom_writer.h"
#include "pipeline/volume/level_scale.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_recording.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;
using testing::Not;
using tests::small_recording_entry;
using tests::small_recording_facts;
using tests::small_recording_volume;

// A DICOM file as DCMTK reads it.
class DicomFile {
public:
  explicit DicomFile(const std::filesystem::path& path) {
    const OFCondition loaded = file_.loadFile(path.c_str());
    EXPECT_TRUE(loaded.good()) << path << ": " << loaded.text();
    file_.loadAllDataIntoMemory();
  }
  // All values of an element; "absent" without it.
  std::string text(const DcmTagKey& key) {
    OFString value;
    return file_.getDataset()->findAndGetOFStringArray(key, value, true).good() ? value.c_str()
                                                                                : "absent";
  }
  double number(const DcmTagKey& key, unsigned long which = 0) {
    OFString value;
    return file_.getDataset()->findAndGetOFString(key, value, which, true).good()
               ? std::strtod(value.c_str(), nullptr)
               : std::nan("");
  }
  std::string meta(const DcmTagKey& key) {
    OFString value;
    file_.getMetaInfo()->findAndGetOFString(key, value);
    return value.c_str();
  }
  std::vector<std::uint8_t> pixels() {
    const Uint8* bytes = nullptr;
    unsigned long count = 0;
    EXPECT_TRUE(file_.getDataset()->findAndGetUint8Array(DCM_PixelData, bytes, &count).good());
    return {bytes, bytes + count};
  }

private:
  DcmFileFormat file_;
};

class DicomVolume : public testing::Test {
protected:
  // The nth volume of the small recording with these facts, written and read again.
  DicomFile write(const RecordingFacts& facts, std::uint64_t n = 0) {
    auto writer = DicomWriter::create(facts, small_recording_entry(0), options);
    EXPECT_TRUE(writer) << writer.error().message;
    const auto written =
        writer->write(path, small_recording_volume(n), small_recording_entry(n), n);
    EXPECT_TRUE(written) << written.error().message;
    return DicomFile{path};
  }

  tests::ScratchFolder folder;
  std::filesystem::path path = folder / "v.dcm";
  DicomOptions options{{.lowest_db = 8, .size_db = 36}, std::nullopt, "octascope 9.9.9"};
};

TEST_F(DicomVolume, is_what_it_says) {
  DicomFile file = write(small_recording_facts(), 2);
  EXPECT_EQ(file.meta(DCM_TransferSyntaxUID), UID_LittleEndianExplicitTransferSyntax);
  EXPECT_EQ(file.meta(DCM_MediaStorageSOPClassUID), "1.2.840.10008.5.1.4.1.1.7.2");
  EXPECT_EQ(file.meta(DCM_MediaStorageSOPInstanceUID), file.text(DCM_SOPInstanceUID));
  EXPECT_EQ(file.text(DCM_SOPClassUID), "1.2.840.10008.5.1.4.1.1.7.2");
  EXPECT_EQ(file.text(DCM_SpecificCharacterSet), "ISO_IR 192");
  EXPECT_EQ(file.text(DCM_Modality), "OPT");
  EXPECT_EQ(file.text(DCM_ImageType), "ORIGINAL\\PRIMARY");
  EXPECT_EQ(file.text(DCM_InstanceNumber), "3");
  EXPECT_EQ(file.text(DCM_SeriesNumber), "1");
  EXPECT_EQ(file.text(DCM_Manufacturer), "octascope");
  EXPECT_EQ(file.text(DCM_SoftwareVersions), "octascope, in a test");
  EXPECT_EQ(file.text(DCM_SecondaryCaptureDeviceSoftwareVersions), "octascope 9.9.9");
  EXPECT_EQ(file.text(DCM_BurnedInAnnotation), "NO");
  EXPECT_EQ(file.text(DCM_LossyImageCompression), "00");
}

TEST_F(DicomVolume, holds_every_level_where_a_viewer_looks_for_it) {
  for (const std::uint64_t n : {0U, 1U, 4U}) {
    DicomFile file = write(small_recording_facts(), n);
    const Volume volume = small_recording_volume(n);
    const VolumeGeometry& g = volume.geometry;
    EXPECT_EQ(file.number(DCM_NumberOfFrames), g.b_scans);
    EXPECT_EQ(file.number(DCM_Rows), g.depths);
    EXPECT_EQ(file.number(DCM_Columns), g.a_scans);
    EXPECT_EQ(file.text(DCM_PhotometricInterpretation), "MONOCHROME2");
    EXPECT_EQ(file.number(DCM_SamplesPerPixel), 1);
    EXPECT_EQ(file.number(DCM_BitsAllocated), 8);
    EXPECT_EQ(file.number(DCM_BitsStored), 8);
    EXPECT_EQ(file.number(DCM_HighBit), 7);
    EXPECT_EQ(file.number(DCM_PixelRepresentation), 0);
    const std::vector<std::uint8_t> pixels = file.pixels();
    ASSERT_EQ(pixels.size(), g.voxels());
    std::size_t i = 0;
    for (int b = 0; b < g.b_scans; ++b) {
      for (int row = 0; row < g.depths; ++row) {
        for (int column = 0; column < g.a_scans; ++column, ++i)
          ASSERT_EQ(pixels[i], volume.b_scan(b)[static_cast<std::size_t>(column * g.depths + row)])
              << "frame " << b << ", row " << row << ", column " << column;
      }
    }
  }
}

TEST_F(DicomVolume, of_an_odd_size_is_padded_with_one_byte) {
  RecordingFacts facts = small_recording_facts();
  facts.geometry = {3, 5, 1, 3.5, 10, 37.5};
  Volume volume{facts.geometry};
  std::ranges::fill(volume.levels, std::uint8_t{77});
  auto writer = tests::must(DicomWriter::create(facts, small_recording_entry(0), options));
  ASSERT_TRUE(writer.write(path, volume, small_recording_entry(0), 0));
  DicomFile file{path};
  std::vector<std::uint8_t> expected(15, 77);
  expected.push_back(0);
  EXPECT_EQ(file.pixels(), expected);
  // One frame has no next one, and no place in a row.
  EXPECT_EQ(file.text(DCM_NumberOfFrames), "1");
  EXPECT_EQ(file.text(DCM_FrameIncrementPointer), "absent");
  EXPECT_EQ(file.text(DCM_SliceLocationVector), "absent");
}

TEST_F(DicomVolume, has_its_lengths_in_millimetres_rows_first) {
  DicomFile file = write(small_recording_facts());
  EXPECT_EQ(file.text(DCM_PixelSpacing), "0.0035\\0.01");
  EXPECT_EQ(file.text(DCM_SpacingBetweenSlices), "0.0375");
  EXPECT_EQ(file.text(DCM_SliceLocationVector), "0\\0.0375\\0.075\\0.1125\\0.15");
  EXPECT_EQ(file.text(DCM_FrameIncrementPointer), "(0018,2005)");
}

TEST_F(DicomVolume, says_what_a_count_is_in_decibels) {
  DicomFile file = write(small_recording_facts());
  // The only ones that this kind of image allows.
  EXPECT_EQ(file.text(DCM_RescaleIntercept), "0");
  EXPECT_EQ(file.text(DCM_RescaleSlope), "1");
  EXPECT_EQ(file.text(DCM_RescaleType), "US");
  EXPECT_EQ(file.text(DCM_PresentationLUTShape), "IDENTITY");
  const double slope = file.number(DCM_RealWorldValueSlope);
  const double intercept = file.number(DCM_RealWorldValueIntercept);
  EXPECT_EQ(file.number(DCM_RealWorldValueFirstValueMapped), 0);
  EXPECT_EQ(file.number(DCM_RealWorldValueLastValueMapped), 255);
  for (const int count : {0, 1, 100, 255})
    EXPECT_FLOAT_EQ(static_cast<float>(intercept + slope * count),
                    level_db(static_cast<float>(count)));
  EXPECT_EQ(file.text(DCM_CodeValue), "dB");
  EXPECT_EQ(file.text(DCM_CodingSchemeDesignator), "UCUM");
}

// The linear function of PS3.3, C.11.2.1.2.1, from 0 to 1.
double shown(double count, double centre, double width) {
  if (count <= centre - 0.5 - (width - 1) / 2)
    return 0;
  if (count > centre - 0.5 + (width - 1) / 2)
    return 1;
  return (count - (centre - 0.5)) / (width - 1) + 0.5;
}

TEST_F(DicomVolume, is_shown_in_the_window_that_was_asked_for) {
  DicomFile file = write(small_recording_facts());
  const double centre = file.number(DCM_WindowCenter);
  const double width = file.number(DCM_WindowWidth);
  for (int count = 0; count < 256; ++count) {
    const double expected =
        std::clamp((double{level_db(static_cast<float>(count))} - 8) / 36, 0.0, 1.0);
    EXPECT_NEAR(shown(count, centre, width), expected, 1e-9) << count;
  }
}

TEST_F(DicomVolume, knows_whom_and_which_eye_it_shows) {
  RecordingFacts facts = small_recording_facts();
  DicomFile left = write(facts);
  EXPECT_EQ(left.text(DCM_PatientID), "Müller, 17");
  EXPECT_EQ(left.text(DCM_PatientName), "");
  EXPECT_EQ(left.text(DCM_PatientBirthDate), "");
  EXPECT_EQ(left.text(DCM_PatientSex), "");
  EXPECT_EQ(left.text(DCM_BodyPartExamined), "EYE");
  EXPECT_EQ(left.text(DCM_ImageLaterality), "L");
  EXPECT_EQ(left.text(DCM_Laterality), "absent"); // one of the two, by the standard
  facts.eye = Eye::right;
  EXPECT_EQ(write(facts).text(DCM_ImageLaterality), "R");
  facts.eye = Eye::not_said;
  facts.subject.clear();
  DicomFile nobody = write(facts);
  EXPECT_EQ(nobody.text(DCM_PatientID), "");
  EXPECT_EQ(nobody.text(DCM_ImageLaterality), "absent");
  EXPECT_EQ(nobody.text(DCM_Laterality), "");
  EXPECT_EQ(nobody.text(DCM_BodyPartExamined), "absent");
  EXPECT_EQ(nobody.text(DCM_Modality), "OCT");
}

TEST_F(DicomVolume, takes_another_subject_or_none_where_that_is_asked_for) {
  options.patient_id = "A-17";
  EXPECT_EQ(write(small_recording_facts()).text(DCM_PatientID), "A-17");
  options.patient_id = "";
  EXPECT_EQ(write(small_recording_facts()).text(DCM_PatientID), "");
}

TEST_F(DicomVolume, refuses_a_subject_that_is_no_patient_id) {
  RecordingFacts facts = small_recording_facts();
  for (const std::string& subject :
       {std::string(65, 'x'), std::string{"a\\b"}, std::string{"a\nb"}, std::string{"\xFF"}}) {
    facts.subject = subject;
    const auto writer = DicomWriter::create(facts, small_recording_entry(0), options);
    ASSERT_FALSE(writer) << subject;
    EXPECT_EQ(writer.error().code, hal::ErrorCode::invalid_argument);
    EXPECT_THAT(writer.error().message, HasSubstr("--subject"));
  }
  facts.subject.clear();
  for (int i = 0; i < 64; ++i)
    facts.subject += "ü"; // characters count, not bytes
  EXPECT_EQ(write(facts).text(DCM_PatientID), facts.subject);
}

TEST_F(DicomVolume, says_in_four_places_that_it_is_simulated) {
  DicomFile simulated = write(small_recording_facts());
  EXPECT_THAT(simulated.text(DCM_ImageComments), HasSubstr("SIMULATED"));
  EXPECT_THAT(simulated.text(DCM_SeriesDescription), HasSubstr("SIMULATED"));
  EXPECT_THAT(simulated.text(DCM_StudyDescription), HasSubstr("SIMULATED"));
  EXPECT_EQ(simulated.text(DCM_QualityControlImage), "YES");
  EXPECT_EQ(simulated.text(DCM_ConversionType), "SYN");
  RecordingFacts facts = small_recording_facts();
  facts.simulated = false;
  DicomFile real = write(facts);
  EXPECT_THAT(real.text(DCM_ImageComments), Not(HasSubstr("SIMULATED")));
  EXPECT_THAT(real.text(DCM_SeriesDescription), Not(HasSubstr("SIMULATED")));
  EXPECT_THAT(real.text(DCM_StudyDescription), Not(HasSubstr("SIMULATED")));
  EXPECT_EQ(real.text(DCM_QualityControlImage), "NO");
  EXPECT_EQ(real.text(DCM_ConversionType), "WSD");
}

TEST_F(DicomVolume, says_what_is_missing) {
  EXPECT_THAT(write(small_recording_facts(), 3).text(DCM_ImageComments),
              HasSubstr("Missing B-scans (frames from 0), black: 1."));
}

TEST_F(DicomVolume, has_the_times_of_the_place_where_it_was_recorded) {
  DicomFile file = write(small_recording_facts(), 2); // 282 ms after the first
  EXPECT_EQ(file.text(DCM_ContentDate), "20261122");
  EXPECT_EQ(file.text(DCM_ContentTime), "121003.282000");
  // Its first line came 137 ms before it was ready; the recording's began so with its first volume.
  EXPECT_EQ(file.text(DCM_AcquisitionDateTime), "20261122121003.145000+0100");
  EXPECT_EQ(file.text(DCM_StudyDate), "20261122");
  EXPECT_EQ(file.text(DCM_StudyTime), "121002.863000");
  EXPECT_EQ(file.text(DCM_StudyID), "20261122121002");
  EXPECT_EQ(file.text(DCM_SeriesTime), "121002.863000");
  EXPECT_EQ(file.text(DCM_TimezoneOffsetFromUTC), "+0100");
  RecordingFacts facts = small_recording_facts();
  facts.begun = "some day";
  EXPECT_EQ(write(facts).text(DCM_ContentTime), "111003.000000"); // UTC
}

TEST_F(DicomVolume, of_one_recording_is_one_series_always) {
  std::set<std::string> instances, series, studies;
  const auto add = [&](DicomFile file) {
    instances.insert(file.text(DCM_SOPInstanceUID));
    series.insert(file.text(DCM_SeriesInstanceUID));
    studies.insert(file.text(DCM_StudyInstanceUID));
  };
  for (const std::uint64_t n : {0U, 1U, 2U, 1U})
    add(write(small_recording_facts(), n));
  EXPECT_EQ(instances.size(), 3U); // the same volume, the same way, is the same instance
  options.window.size_db = 20;
  add(write(small_recording_facts(), 1));
  EXPECT_EQ(instances.size(), 4U); // another content, another instance
  EXPECT_EQ(series.size(), 1U);
  EXPECT_EQ(studies.size(), 1U);

  // Another recording that began in the same second.
  RecordedVolume first = small_recording_entry(0);
  ++first.wall_clock_ns;
  auto other = tests::must(DicomWriter::create(small_recording_facts(), first, options));
  ASSERT_TRUE(other.write(path, small_recording_volume(0), first, 0));
  add(DicomFile{path});
  EXPECT_EQ(series.size(), 2U);
  EXPECT_EQ(studies.size(), 2U);
  EXPECT_EQ(instances.size(), 5U);
}

TEST_F(DicomVolume, is_written_alike_each_time) {
  write(small_recording_facts());
  const std::string once = tests::whole_file(path);
  write(small_recording_facts());
  EXPECT_EQ(tests::whole_file(path), once);
}

TEST_F(DicomVolume, is_nobodys_but_its_owners) {
  write(small_recording_facts());
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(path).permissions(), perms::owner_read | perms::owner_write);
}

TEST_F(DicomVolume, appears_complete_or_not_at_all) {
  auto writer =
      tests::must(DicomWriter::create(small_recording_facts(), small_recording_entry(0), options));
  const auto write_to = [&](const std::filesystem::path& where) {
    return writer.write(where, small_recording_volume(0), small_recording_entry(0), 0);
  };
  EXPECT_EQ(write_to(folder / "no/such/v.dcm").error().code, hal::ErrorCode::absent);
  std::filesystem::create_directory(folder / "d");
  EXPECT_EQ(write_to(folder / "d").error().code, hal::ErrorCode::invalid_argument);

  // A disk that is full after 600 bytes.
  folder.write("v.dcm", "the old file");
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit little{600, limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  const auto written = write_to(path);
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("v.dcm: cannot be written: File too large"));
  EXPECT_EQ(std::filesystem::file_size(path), 12U);
  EXPECT_EQ(folder.count(), 2);
}

TEST_F(DicomVolume, of_a_geometry_that_dicom_does_not_know_is_refused) {
  RecordingFacts facts = small_recording_facts();
  for (const auto& [depths, b_scans] : {std::pair{65536, 5}, std::pair{12, 20000}}) {
    facts.geometry.depths = depths;
    facts.geometry.b_scans = b_scans;
    const auto writer = DicomWriter::create(facts, small_recording_entry(0), options);
    ASSERT_FALSE(writer) << depths << " " << b_scans;
    EXPECT_EQ(writer.error().code, hal::ErrorCode::unsupported);
  }
  auto writer =
      tests::must(DicomWriter::create(small_recording_facts(), small_recording_entry(0), options));
  EXPECT_FALSE(writer.write(path, Volume{{12, 7, 6, 3.5, 10, 37.5}}, small_recording_entry(0), 0));
}

// What dciodvfy says of a file; the test fails where it is an error.
void expect_no_errors(const std::filesystem::path& file) {
  const auto out = file.parent_path() / "verdict";
  const int status =
      std::system(fmt::format("dciodvfy {} > {} 2>&1", file.string(), out.string()).c_str());
  const std::string verdict = tests::whole_file(out);
  EXPECT_EQ(status, 0) << verdict;
  EXPECT_THAT(verdict, Not(HasSubstr("Error")));
}

TEST_F(DicomVolume, satisfies_a_checker_of_the_standard) {
  if (std::system("command -v dciodvfy > /dev/null") != 0)
    GTEST_SKIP() << "no dciodvfy (Debian package dicom3tools)";
  RecordingFacts facts = small_recording_facts();
  for (const Eye eye : {Eye::left, Eye::right, Eye::not_said}) {
    facts.eye = eye;
    facts.simulated = eye == Eye::left;
    write(facts);
    expect_no_errors(path);
  }
}

TEST_F(DicomVolume, of_any_size_satisfies_a_checker_of_the_standard) {
  if (std::system("command -v dciodvfy > /dev/null") != 0)
    GTEST_SKIP() << "no dciodvfy (Debian package dicom3tools)";
  RecordingFacts facts = small_recording_facts();
  for (const VolumeGeometry& geometry : {VolumeGeometry{6, 4, 1, 3.5, 10, 37.5},
                                         {6, 4, 2, 3.5, 10, 37.5},
                                         {6, 4, 3, 3.5, 10, 1.0 / 3},
                                         {6, 4, 80, 3.5, 10, 37.5},
                                         {1, 1, 1, 3.5, 10, 37.5},
                                         {7, 1, 300, 0.001, 1e4, 1e-5},
                                         {1, 9, 1, 1e4, 0.001, 1e4}}) {
    SCOPED_TRACE(fmt::format("{} x {} x {}", geometry.depths, geometry.a_scans, geometry.b_scans));
    facts.geometry = geometry;
    auto writer = tests::must(DicomWriter::create(facts, small_recording_entry(0), options));
    Volume volume{geometry};
    std::ranges::fill(volume.b_scan_states, BScanState::missing);
    const auto written = writer.write(path, volume, small_recording_entry(0), 0);
    ASSERT_TRUE(written) << written.error().message;
    expect_no_errors(path);
  }
}

TEST(DicomUid, is_the_hash_as_a_uuid_in_decimal) {
  // XXH3's 128 bits of nothing are 99aa06d3014798d86001c324468d497f; version and variant set, the
  // number was written in decimal by another program.
  EXPECT_EQ(derive_uid(""), "2.25.204254712233038926651812525534897588607");
  EXPECT_LE(derive_uid("a").size(), 64U);
  EXPECT_NE(derive_uid("a"), derive_uid("b"));
}

TEST(DicomText, fits_or_is_made_to_fit) {
  EXPECT_TRUE(is_long_string(""));
  EXPECT_TRUE(is_long_string("phantom eye, 2.3 µm"));
  for (const char* none : {"\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xC2",
                           "\x80", "a\\b", "tab\t", "\xC2\x85"})
    EXPECT_FALSE(is_long_string(none)) << none;
  EXPECT_EQ(to_long_string("a\\b\nc\xFF"
                           "d"),
            "a/b c?d");
  EXPECT_EQ(to_long_string(std::string(70, 'x')), std::string(64, 'x'));
  EXPECT_TRUE(is_long_string(to_long_string("\xF0\x9F\x91\x81 \xC2\x85 \xE2\x82")));
}

TEST(DicomText, numbers_have_sixteen_bytes_at_most) {
  EXPECT_EQ(to_decimal_string(0.0035), "0.0035");
  EXPECT_EQ(to_decimal_string(3.5 / 1000), "0.0035");
  for (const double value : {1.0 / 3, -1.0 / 3e5, 1e300 / 7, -1e-300 / 7})
    EXPECT_LE(to_decimal_string(value).size(), 16U) << value;
}

TEST(DicomText, times_have_an_offset) {
  using std::chrono::minutes;
  EXPECT_EQ(offset_from_utc("2026-11-22T12:10:03+01:00"), minutes{60});
  EXPECT_EQ(offset_from_utc("2026-11-22T12:10:03-03:30"), minutes{-210});
  EXPECT_EQ(offset_from_utc("2026-11-22T12:10:03Z"), minutes{0});
  for (const char* none : {"", "2026-11-22T12:10:03", "+99:00", "+0100", "x01:00"})
    EXPECT_EQ(offset_from_utc(none), std::nullopt) << none;
  const DicomTime time = to_dicom_time(1'795'345'803'141'592'653, minutes{-690});
  EXPECT_EQ(time.date, "20261121");
  EXPECT_EQ(time.time, "234003.141592");
  EXPECT_EQ(time.date_time(), "20261121234003.141592-1130");
}

} // namespace
} // namespace octascope::pipeline
