#include "pipeline/recordings/dicom/dicom_writer.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pipeline/files/atomic_file.h"
#include "pipeline/recordings/dicom/dicom_item.h"
#include "pipeline/recordings/dicom/dicom_output.h"
#include "pipeline/recordings/dicom/dicom_text.h"
#include "pipeline/recordings/dicom/dicom_uid.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::pipeline {

using hal::ErrorCode;

namespace {

constexpr int most_columns = 65535;                    // US
constexpr std::size_t most_text_bytes = 65534;         // of an element with a length of 16 bits
constexpr std::uint64_t most_pixel_bytes = 0xFFFFFFFE; // an even 32-bit length
constexpr int most_listed_b_scans = 100;

std::string slice_locations(const VolumeGeometry& geometry) {
  std::string text;
  for (int b = 0; b < geometry.b_scans; ++b)
    text += fmt::format("{}{}", b == 0 ? "" : "\\",
                        to_decimal_string(b * geometry.b_spacing_um / 1000));
  return text;
}

hal::Result<> check(const VolumeGeometry& g) {
  if (g.depths >= 1 && g.depths <= most_columns && g.a_scans >= 1 && g.a_scans <= most_columns &&
      g.b_scans >= 1 && g.voxels() <= most_pixel_bytes &&
      slice_locations(g).size() <= most_text_bytes)
    return {};
  return hal::fail(ErrorCode::unsupported,
                   "DICOM: found volumes of {} depths × {} A-scans × {} B-scans, expected at most "
                   "{} × {} of {} voxels, and fewer than some thousand B-scans; NRRD takes any",
                   g.depths, g.a_scans, g.b_scans, most_columns, most_columns, most_pixel_bytes);
}

// DCMTK makes the head of a file from its dictionary, and without it a wrong one.
hal::Result<> check_dictionary() {
  if (dcmDataDict.isDictionaryLoaded())
    return {};
  return hal::fail(ErrorCode::absent,
                   "DICOM: DCMTK's dictionary cannot be read, expected dicom.dic in "
                   "/usr/share/libdcmtk17 (Debian package libdcmtk17), or where DCMDICTPATH says");
}

hal::Result<> check_patient_id(const std::string& id) {
  if (is_long_string(id))
    return {};
  return hal::fail(
      ErrorCode::invalid_argument,
      "DICOM: found the subject \"{}\", expected for a patient ID at most 64 characters of UTF-8, "
      "no backslash, no control characters; --subject gives another",
      id);
}

// [b][a][z] to [b][z][a].
void turn_frames(const Volume& volume, std::vector<std::uint8_t>& frames) {
  const auto depths = static_cast<std::size_t>(volume.geometry.depths);
  const auto a_scans = static_cast<std::size_t>(volume.geometry.a_scans);
  frames.resize(volume.geometry.voxels());
  for (std::size_t begin = 0; begin < frames.size(); begin += depths * a_scans) {
    const std::uint8_t* from = volume.levels.data() + begin;
    std::uint8_t* to = frames.data() + begin;
    for (std::size_t a = 0; a < a_scans; ++a) {
      for (std::size_t z = 0; z < depths; ++z)
        to[z * a_scans + a] = from[a * depths + z];
    }
  }
}

std::string missing_b_scans(const Volume& volume) {
  std::string text;
  int count = 0;
  for (std::size_t b = 0; b < volume.b_scan_states.size(); ++b) {
    if (volume.b_scan_states[b] == BScanState::missing && ++count <= most_listed_b_scans)
      text += fmt::format("{}{}", count == 1 ? "" : ", ", b);
  }
  if (count > most_listed_b_scans)
    text += fmt::format(" and {} more", count - most_listed_b_scans);
  return text;
}

// What no other element has, in words.
std::string comments(const RecordingFacts& facts, const Volume& volume, const RecordedVolume& entry,
                     std::size_t n) {
  std::string text = facts.simulated ? "SIMULATED: some or all of it is not the patient's.\n" : "";
  text += fmt::format("Volume {} of the recording begun {}, from {}; it came as number {}.", n,
                      facts.begun, facts.source, entry.index);
  if (const AssumedSpacings& assumed = facts.geometry.assumed; assumed.any())
    text += fmt::format("\nSpacings that are assumed, not measured: {}.", assumed.words());
  if (volume.missing_b_scans() > 0)
    text += fmt::format("\nMissing B-scans (frames from 0), black: {}.", missing_b_scans(volume));
  if (entry.saturated_lines > 0)
    text += fmt::format("\nSaturated lines: {}.", entry.saturated_lines);
  return text;
}

void put_patient(DicomItem& item, const std::string& patient_id) {
  item.put(DCM_PatientName, EVR_PN, "");
  item.put(DCM_PatientID, EVR_LO, patient_id);
  item.put(DCM_PatientBirthDate, EVR_DA, "");
  item.put(DCM_PatientSex, EVR_CS, "");
}

void put_study_and_series(DicomItem& item, const RecordingFacts& facts, const std::string& name) {
  item.put(DCM_StudyInstanceUID, EVR_UI, derive_uid("study " + name));
  item.put(DCM_AccessionNumber, EVR_SH, "");
  item.put(DCM_ReferringPhysicianName, EVR_PN, "");
  item.put(DCM_StudyDescription, EVR_LO,
           facts.simulated ? "SIMULATED OCT recording" : "OCT recording");
  item.put(DCM_SeriesInstanceUID, EVR_UI, derive_uid("series " + name));
  item.put(DCM_SeriesNumber, EVR_IS, "1");
  item.put(DCM_SeriesDescription, EVR_LO,
           to_long_string(fmt::format(
               "{}{}", facts.simulated ? "SIMULATED " : "OCT volumes: ", facts.source)));
  // Optical coherence tomography, of an eye or of something else.
  item.put(DCM_Modality, EVR_CS, facts.eye == Eye::not_said ? "OCT" : "OPT");
}

void put_eye(DicomItem& item, Eye eye) {
  if (eye == Eye::not_said) {
    item.put(DCM_Laterality, EVR_CS, ""); // not known
    return;
  }
  item.put(DCM_BodyPartExamined, EVR_CS, "EYE");
  item.put(DCM_ImageLaterality, EVR_CS, eye == Eye::left ? "L" : "R");
}

void put_equipment(DicomItem& item, const RecordingFacts& facts, const std::string& exported_by) {
  item.put(DCM_Manufacturer, EVR_LO, "octascope");
  item.put(DCM_ManufacturerModelName, EVR_LO, "octascope");
  item.put(DCM_SoftwareVersions, EVR_LO, to_long_string(facts.recorded_by));
  item.put(DCM_ConversionType, EVR_CS, facts.simulated ? "SYN" : "WSD");
  item.put(DCM_SecondaryCaptureDeviceSoftwareVersions, EVR_LO, to_long_string(exported_by));
}

void put_geometry(DicomItem& item, const VolumeGeometry& g, const std::string& slice_locations_mm) {
  item.put(DCM_NumberOfFrames, EVR_IS, std::to_string(g.b_scans));
  if (g.b_scans > 1) { // of a single frame nothing says what comes next (PS3.3, C.7.6.6)
    item.put(DCM_FrameIncrementPointer, DCM_SliceLocationVector);
    item.put(DCM_SliceLocationVector, EVR_DS, slice_locations_mm);
  }
  item.put(DCM_Rows, static_cast<std::uint16_t>(g.depths));
  item.put(DCM_Columns, static_cast<std::uint16_t>(g.a_scans));
  // Between rows first.
  item.put(DCM_PixelSpacing, EVR_DS,
           fmt::format("{}\\{}", to_decimal_string(g.depth_spacing_um / 1000),
                       to_decimal_string(g.a_spacing_um / 1000)));
  item.put(DCM_SpacingBetweenSlices, EVR_DS, to_decimal_string(g.b_spacing_um / 1000));
}

// The decibels of the counts. Rescale Slope and Intercept would be read by more viewers, but this
// kind of image allows none but 1 and 0 (PS3.3, A.8.3.4; in older editions C.8.6.3).
void put_decibels(DicomItem& item) {
  item.put(DCM_RescaleIntercept, EVR_DS, "0");
  item.put(DCM_RescaleSlope, EVR_DS, "1");
  item.put(DCM_RescaleType, EVR_LO, "US");
  item.put_item(DCM_RealWorldValueMappingSequence, [](DicomItem& mapping) {
    mapping.put(DCM_RealWorldValueFirstValueMapped, std::uint16_t{0});
    mapping.put(DCM_RealWorldValueLastValueMapped, std::uint16_t{255});
    mapping.put(DCM_RealWorldValueIntercept, double{lowest_level_db});
    mapping.put(DCM_RealWorldValueSlope, double{level_step_db});
    mapping.put(DCM_LUTExplanation, EVR_LO, "Level, 20 log10(|Y|/N) of camera counts");
    mapping.put(DCM_LUTLabel, EVR_SH, "LEVEL");
    mapping.put_item(DCM_MeasurementUnitsCodeSequence, [](DicomItem& unit) {
      unit.put(DCM_CodeValue, EVR_SH, "dB");
      unit.put(DCM_CodingSchemeDesignator, EVR_SH, "UCUM");
      unit.put(DCM_CodeMeaning, EVR_LO, "decibel");
    });
  });
}

// The linear function of a viewer has its ends half a count inside the window and is a count
// narrower (PS3.3, C.11.2.1.2.1): so black is what lies at the window's lower end, white at its
// upper.
void put_window(DicomItem& item, const DicomWindow& window) {
  const double counts = window.size_db / level_step_db;
  const double lowest = level_count(window.lowest_db);
  item.put(DCM_WindowCenter, EVR_DS, to_decimal_string(lowest + counts / 2 + 0.5));
  item.put(DCM_WindowWidth, EVR_DS, to_decimal_string(counts + 1));
}

void put_pixels(DicomItem& item, std::span<const std::uint8_t> frames) {
  item.put(DCM_SamplesPerPixel, std::uint16_t{1});
  item.put(DCM_PhotometricInterpretation, EVR_CS, "MONOCHROME2");
  item.put(DCM_BitsAllocated, std::uint16_t{8});
  item.put(DCM_BitsStored, std::uint16_t{8});
  item.put(DCM_HighBit, std::uint16_t{7});
  item.put(DCM_PixelRepresentation, std::uint16_t{0});
  item.put(DCM_PresentationLUTShape, EVR_CS, "IDENTITY");
  item.put(DCM_LossyImageCompression, EVR_CS, "00");
  item.put(DCM_BurnedInAnnotation, EVR_CS, "NO");
  item.put(DCM_PixelData, frames);
}

// When its first line came, on the wall clock.
std::int64_t acquired_ns(const RecordedVolume& entry) {
  return entry.wall_clock_ns - std::max<std::int64_t>(entry.published_ns - entry.first_line_ns, 0);
}

void put_times(DicomItem& item, const RecordedVolume& entry, std::chrono::minutes offset) {
  const DicomTime ready = to_dicom_time(entry.wall_clock_ns, offset);
  item.put(DCM_ContentDate, EVR_DA, ready.date);
  item.put(DCM_ContentTime, EVR_TM, ready.time);
  item.put(DCM_AcquisitionDateTime, EVR_DT, to_dicom_time(acquired_ns(entry), offset).date_time());
  item.put(DCM_TimezoneOffsetFromUTC, EVR_SH, ready.offset);
}

hal::Result<> write_file(const std::filesystem::path& path, DcmFileFormat& content) {
  HAL_TRY(auto file, AtomicFile::create(path, Readers::owner));
  DicomConsumer consumer{file};
  OFCondition written;
  {
    DicomOutput output{consumer};
    content.transferInit();
    written = content.write(output, EXS_LittleEndianExplicit, EET_ExplicitLength, nullptr);
    content.transferEnd();
  }
  if (!consumer.outcome())
    return consumer.outcome();
  if (written.bad())
    return hal::fail(ErrorCode::system, "{}: DICOM cannot be written: {}", path.string(),
                     written.text());
  return file.commit();
}

} // namespace

hal::Result<DicomWriter> DicomWriter::create(const RecordingFacts& facts,
                                             const RecordedVolume& first,
                                             const DicomOptions& options) {
  HAL_CHECK(check(facts.geometry));
  HAL_CHECK(check_dictionary());
  HAL_CHECK(check_patient_id(options.patient_id.value_or(facts.subject)));
  // Not the subject: who has a UID must not be able to try names on it.
  std::string name = fmt::format("octascope {} {} {} {}", facts.recorded_by, facts.begun,
                                 first.wall_clock_ns, first.first_line_ns);
  DicomWriter writer{facts, options, std::move(name)};
  const DicomTime begun = to_dicom_time(acquired_ns(first), writer.offset_from_utc_);
  writer.begun_date_ = begun.date;
  writer.begun_time_ = begun.time;
  return writer;
}

DicomWriter::DicomWriter(RecordingFacts facts, DicomOptions options, std::string name)
    : facts_(std::move(facts)), options_(std::move(options)), name_(std::move(name)),
      offset_from_utc_(offset_from_utc(facts_.begun).value_or(std::chrono::minutes{0})),
      slice_locations_mm_(slice_locations(facts_.geometry)) {}

hal::Result<> DicomWriter::write(const std::filesystem::path& file, const Volume& volume,
                                 const RecordedVolume& entry, std::size_t n) {
  if (volume.geometry != facts_.geometry)
    return hal::fail(ErrorCode::invalid_argument,
                     "{}: volume {} is of another geometry than its recording", file.string(), n);
  turn_frames(volume, frames_);
  const std::string patient_id = options_.patient_id.value_or(facts_.subject);
  DcmFileFormat content;
  DicomItem item{*content.getDataset()};
  item.put(DCM_SpecificCharacterSet, EVR_CS, "ISO_IR 192");
  item.put(DCM_SOPClassUID, EVR_UI, UID_MultiframeGrayscaleByteSecondaryCaptureImageStorage);
  // A file with other contents is another instance.
  item.put(DCM_SOPInstanceUID, EVR_UI,
           derive_uid(fmt::format("instance {} {} {} {} {} {}", name_, n, options_.window.lowest_db,
                                  options_.window.size_db, patient_id, options_.exported_by)));
  item.put(DCM_ImageType, EVR_CS, "ORIGINAL\\PRIMARY");
  item.put(DCM_StudyID, EVR_SH, begun_date_ + begun_time_.substr(0, 6));
  item.put(DCM_StudyDate, EVR_DA, begun_date_);
  item.put(DCM_StudyTime, EVR_TM, begun_time_);
  item.put(DCM_SeriesDate, EVR_DA, begun_date_);
  item.put(DCM_SeriesTime, EVR_TM, begun_time_);
  put_times(item, entry, offset_from_utc_);
  put_patient(item, patient_id);
  put_study_and_series(item, facts_, name_);
  put_eye(item, facts_.eye);
  put_equipment(item, facts_, options_.exported_by);
  item.put(DCM_InstanceNumber, EVR_IS, std::to_string(n + 1));
  item.put(DCM_PatientOrientation, EVR_CS, ""); // nobody told the program
  item.put(DCM_QualityControlImage, EVR_CS, facts_.simulated ? "YES" : "NO");
  item.put(DCM_ImageComments, EVR_LT, comments(facts_, volume, entry, n));
  put_geometry(item, facts_.geometry, slice_locations_mm_);
  put_decibels(item);
  put_window(item, options_.window);
  put_pixels(item, frames_);
  if (item.condition().bad())
    return hal::fail(ErrorCode::system, "{}: DICOM cannot hold it: {}", file.string(),
                     item.condition().text());
  return write_file(file, content);
}

} // namespace octascope::pipeline
