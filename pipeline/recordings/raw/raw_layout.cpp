#include "pipeline/recordings/raw/raw_layout.h"

#include <cstddef>

namespace octascope::pipeline::raw_layout {

Hdf5Handle frame_type() {
  Hdf5Handle type{H5Tcreate(H5T_COMPOUND, sizeof(RawFrame)), H5Tclose};
  const auto member = [&](const char* name, std::size_t offset, hid_t of) {
    H5Tinsert(type, name, offset, of);
  };
  member("volume", offsetof(RawFrame, volume), H5T_NATIVE_UINT64);
  member("b_scan", offsetof(RawFrame, b_scan), H5T_NATIVE_INT32);
  member("repeat", offsetof(RawFrame, repeat), H5T_NATIVE_INT32);
  member("sequence", offsetof(RawFrame, sequence), H5T_NATIVE_UINT64);
  member("first_line_ns", offsetof(RawFrame, first_line_ns), H5T_NATIVE_INT64);
  member("last_line_ns", offsetof(RawFrame, last_line_ns), H5T_NATIVE_INT64);
  member("wall_clock_ns", offsetof(RawFrame, wall_clock_ns), H5T_NATIVE_INT64);
  member("scan_lag_a_scans", offsetof(RawFrame, scan_lag_a_scans), H5T_NATIVE_DOUBLE);
  member("crc32", offsetof(RawFrame, crc32), H5T_NATIVE_UINT32);
  return type;
}

hid_t sample_type(hal::SampleType type) {
  switch (type) {
  case hal::SampleType::u8: return H5T_STD_U8LE;
  case hal::SampleType::u16: return H5T_STD_U16LE;
  case hal::SampleType::f32: break;
  }
  return H5T_IEEE_F32LE;
}

std::array<hsize_t, 3> spectra_size(const hal::LineFormat& format, hsize_t frames) {
  return {frames, static_cast<hsize_t>(format.lines_per_frame),
          static_cast<hsize_t>(format.samples_per_line)};
}

std::array<hsize_t, 2> backgrounds_size(const hal::LineFormat& format, hsize_t frames) {
  return {frames, static_cast<hsize_t>(format.samples_per_line)};
}

} // namespace octascope::pipeline::raw_layout
