#include "pipeline/recordings/raw/raw_writer.h"

#include <array>

#include "pipeline/files/crc32.h"
#include "pipeline/recordings/hdf5/attributes.h"
#include "pipeline/recordings/hdf5/growing_file.h"
#include "pipeline/recordings/raw/raw_attributes.h"
#include "pipeline/recordings/raw/raw_layout.h"

namespace octascope::pipeline {

namespace layout = raw_layout;

namespace {

constexpr hsize_t entries_a_chunk = 256;

} // namespace

struct RawWriter::File {
  bool make_datasets(hid_t file);
  bool flush() {
    return H5Dflush(spectra) >= 0 && (!backgrounds.valid() || H5Dflush(backgrounds) >= 0) &&
           H5Dflush(frames) >= 0;
  }

  hal::LineFormat format;
  bool has_backgrounds = false;
  hsize_t count = 0;
  std::unique_ptr<GrowingFile> file; // closes last but for its types
  Hdf5Handle spectra, backgrounds, frames, entry_type;
};

bool RawWriter::File::make_datasets(hid_t made) {
  entry_type = layout::frame_type();
  spectra = make_growing_dataset(made, layout::spectra, layout::sample_type(format.sample_type),
                                 layout::spectra_size(format, 1), Chunks::written_whole);
  frames = make_growing_dataset(made, layout::frames, entry_type, std::array{entries_a_chunk},
                                Chunks::filled_by_rows);
  if (has_backgrounds)
    backgrounds = make_growing_dataset(made, layout::backgrounds, H5T_IEEE_F32LE,
                                       layout::backgrounds_size(format, 1), Chunks::written_whole);
  return spectra.valid() && frames.valid() && backgrounds.valid() == has_backgrounds;
}

RawWriter::RawWriter(std::unique_ptr<File> file) : file_(std::move(file)) {}
RawWriter::RawWriter(RawWriter&&) noexcept = default;
RawWriter& RawWriter::operator=(RawWriter&&) noexcept = default;

RawWriter::~RawWriter() {
  const Hdf5Silence silence;
  file_.reset();
}

// Chunks begin at pages, so that their samples can be used where they lie in a mapped file.
hal::Result<RawWriter> RawWriter::create(const std::filesystem::path& path, const RawFacts& facts) {
  const Hdf5Silence silence;
  if (facts.format.lines_per_frame > largest_size)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "{}: found {} lines a frame, of which {} are kept, expected at most {} where "
        "raw spectra are kept; scan fewer lines a sweep, or keep levels (record --out) "
        "or a mean (capture --average) instead",
        path.string(), facts.format.lines_per_frame, facts.kept_lines(), largest_size);
  auto made = std::make_unique<File>();
  made->format = facts.format;
  made->has_backgrounds = facts.has_backgrounds();
  HAL_TRY(made->file,
          GrowingFile::create(
              path,
              [&](hid_t file) { return write_raw_facts(file, facts) && made->make_datasets(file); },
              facts.format.frame_bytes()));
  return RawWriter{std::move(made)};
}

hal::Result<> RawWriter::append(RawFrame entry, std::span<const std::byte> frame,
                                std::span<const float> background) {
  const Hdf5Silence silence;
  File& f = *file_;
  if (f.file->broken() || frame.size() != f.format.frame_bytes())
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{}: found a frame of {} bytes{}, expected one of {}, before any failure",
                     f.file->path().string(), frame.size(),
                     f.file->broken() ? " after a failure" : "", f.format.frame_bytes());
  entry.crc32 = crc32_of(frame);
  const hsize_t count = f.count + 1;
  if (!append_chunk(f.spectra, layout::spectra_size(f.format, count), frame) ||
      (f.has_backgrounds && !append_chunk(f.backgrounds, layout::backgrounds_size(f.format, count),
                                          std::as_bytes(background))) ||
      !append_row(f.frames, f.entry_type, std::array{count}, &entry))
    return f.file->failed("a frame cannot be written");
  f.count = count;
  return {};
}

hal::Result<> RawWriter::flush() {
  const Hdf5Silence silence;
  if (file_->file->broken() || file_->flush())
    return {};
  return file_->file->failed("frames cannot be written");
}

hal::Result<> RawWriter::sync() {
  return file_->file->sync();
}

hal::Result<> RawWriter::finish(const RawEnd& end) {
  const Hdf5Silence silence;
  File& f = *file_;
  bool closed = true;
  for (Hdf5Handle* const handle : {&f.frames, &f.backgrounds, &f.spectra})
    closed = handle->close() >= 0 && closed;
  if (!closed)
    return f.file->failed("cannot be closed");
  RawEnd finished = end;
  finished.finished = true;
  return f.file->finish([&](hid_t file) { return write_raw_end(file, finished); });
}

} // namespace octascope::pipeline
