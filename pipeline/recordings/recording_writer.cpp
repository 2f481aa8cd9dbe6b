#include "pipeline/recordings/recording_writer.h"

#include <array>
#include <span>

#include "pipeline/recordings/hdf5/growing_file.h"
#include "pipeline/recordings/recording_attributes.h"
#include "pipeline/recordings/recording_layout.h"

namespace octascope::pipeline {

namespace layout = recording_layout;

namespace {

constexpr hsize_t entries_a_chunk = 256;

} // namespace

struct RecordingWriter::File {
  bool make_datasets(hid_t file);
  bool append_levels(const Volume& volume);
  bool flush() { return H5Dflush(levels) >= 0 && H5Dflush(states) >= 0 && H5Dflush(metadata) >= 0; }

  VolumeGeometry geometry;
  hsize_t volumes = 0;
  std::unique_ptr<GrowingFile> file; // closes last but for its types
  Hdf5Handle levels, states, metadata, entry_type;
};

bool RecordingWriter::File::make_datasets(hid_t made) {
  entry_type = layout::ledger_type();
  levels = make_growing_dataset(made, layout::levels, H5T_STD_U8LE,
                                layout::levels_size(geometry, 1), Chunks::written_whole);
  states =
      make_growing_dataset(made, layout::b_scan_states, H5T_STD_U8LE,
                           layout::states_size(geometry, entries_a_chunk), Chunks::filled_by_rows);
  metadata = make_growing_dataset(made, layout::metadata, entry_type, std::array{entries_a_chunk},
                                  Chunks::filled_by_rows);
  return levels.valid() && states.valid() && metadata.valid();
}

bool RecordingWriter::File::append_levels(const Volume& volume) {
  return append_chunk(levels, layout::levels_size(geometry, volumes + 1),
                      std::as_bytes(std::span{volume.levels}));
}

RecordingWriter::RecordingWriter(std::unique_ptr<File> file) : file_(std::move(file)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;

RecordingWriter::~RecordingWriter() {
  const Hdf5Silence silence;
  file_.reset();
}

hal::Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path,
                                                     const RecordingFacts& facts) {
  const Hdf5Silence silence;
  auto made = std::make_unique<File>();
  made->geometry = facts.geometry;
  HAL_TRY(made->file, GrowingFile::create(path, [&](hid_t file) {
            return write_facts(file, facts) && made->make_datasets(file);
          }));
  return RecordingWriter{std::move(made)};
}

hal::Result<> RecordingWriter::append(const Volume& volume, const RecordedVolume& entry) {
  const Hdf5Silence silence;
  File& f = *file_;
  if (f.file->broken() || volume.geometry != f.geometry)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "{}: found a volume {}, expected one of the recording's own geometry, before any failure",
        f.file->path().string(), f.file->broken() ? "after a failure" : "of another one");
  const std::array<hsize_t, 1> rows{f.volumes + 1};
  if (!f.append_levels(volume) ||
      !append_row(f.states, H5T_NATIVE_UINT8, layout::states_size(f.geometry, rows[0]),
                  volume.b_scan_states.data()) ||
      !append_row(f.metadata, f.entry_type, rows, &entry) || !f.flush())
    return f.file->failed("a volume cannot be written");
  ++f.volumes;
  return {};
}

hal::Result<> RecordingWriter::sync() {
  return file_->file->sync();
}

hal::Result<> RecordingWriter::finish(const RecordingEnd& end) {
  const Hdf5Silence silence;
  File& f = *file_;
  bool closed = true;
  for (Hdf5Handle* const handle : {&f.metadata, &f.states, &f.levels})
    closed = handle->close() >= 0 && closed;
  if (!closed)
    return f.file->failed("cannot be closed");
  RecordingEnd finished = end;
  finished.finished = true;
  return f.file->finish([&](hid_t file) { return write_end(file, finished); });
}

} // namespace octascope::pipeline
