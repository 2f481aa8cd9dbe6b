#include "pipeline/recordings/recording_layout.h"

#include <cstddef>

namespace octascope::pipeline::recording_layout {

Hdf5Handle ledger_type() {
  Hdf5Handle type{H5Tcreate(H5T_COMPOUND, sizeof(RecordedVolume)), H5Tclose};
  const auto member = [&](const char* name, std::size_t offset, hid_t of) {
    H5Tinsert(type, name, offset, of);
  };
  member("index", offsetof(RecordedVolume, index), H5T_NATIVE_UINT64);
  member("first_line_ns", offsetof(RecordedVolume, first_line_ns), H5T_NATIVE_INT64);
  member("last_line_ns", offsetof(RecordedVolume, last_line_ns), H5T_NATIVE_INT64);
  member("published_ns", offsetof(RecordedVolume, published_ns), H5T_NATIVE_INT64);
  member("wall_clock_ns", offsetof(RecordedVolume, wall_clock_ns), H5T_NATIVE_INT64);
  member("lost_b_scans", offsetof(RecordedVolume, lost_b_scans), H5T_NATIVE_INT32);
  member("lost_lines", offsetof(RecordedVolume, lost_lines), H5T_NATIVE_INT32);
  member("saturated_lines", offsetof(RecordedVolume, saturated_lines), H5T_NATIVE_INT32);
  member("phase_offset_a_scans", offsetof(RecordedVolume, scan_lag_a_scans), H5T_NATIVE_DOUBLE);
  return type;
}

std::array<hsize_t, 4> levels_size(const VolumeGeometry& g, hsize_t volumes) {
  return {volumes, static_cast<hsize_t>(g.b_scans), static_cast<hsize_t>(g.a_scans),
          static_cast<hsize_t>(g.depths)};
}

std::array<hsize_t, 2> states_size(const VolumeGeometry& g, hsize_t volumes) {
  return {volumes, static_cast<hsize_t>(g.b_scans)};
}

} // namespace octascope::pipeline::recording_layout
