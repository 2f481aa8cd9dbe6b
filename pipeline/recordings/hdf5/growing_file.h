// A file that grows, row by row, while readers may look on.
//
// What was appended and flushed survives a crash of the program and, if the disk keeps what it
// acknowledges, a power cut: the file is written with HDF5's single-writer-multiple-readers mode
// and is consistent at every moment. It has its final name from the start.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "hal/result.h"
#include "pipeline/recordings/hdf5/descriptor.h"
#include "pipeline/recordings/hdf5/hdf5.h"

namespace octascope::pipeline {

enum class Chunks : std::uint8_t {
  written_whole, // each once, by append_chunk(): none is cached
  filled_by_rows,
};

// Of up to four dimensions, growing along the first.
Hdf5Handle make_growing_dataset(hid_t file, const char* name, hid_t type,
                                std::span<const hsize_t> chunk, Chunks chunks);

// `size`: of the dataset with it. Makes room for one more row and writes it there; append_chunk()
// one that is a chunk, past HDF5's buffers. False: HDF5 failed.
bool append_row(hid_t dataset, hid_t type, std::span<const hsize_t> size, const void* row);
bool append_chunk(hid_t dataset, std::span<const hsize_t> size, std::span<const std::byte> chunk);

// One thread at a time, but for sync().
class GrowingFile {
public:
  // Readable by its owner only: it shows a patient. `fill` makes its attributes and datasets; false:
  // HDF5 failed. Blocks of `aligned_bytes` or more (0: none) begin at a page of the file.
  // ErrorCode::invalid_argument: the file exists already.
  static hal::Result<std::unique_ptr<GrowingFile>> create(const std::filesystem::path& path,
                                                          const std::function<bool(hid_t)>& fill,
                                                          std::size_t aligned_bytes = 0);
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  ~GrowingFile();

  const std::filesystem::path& path() const { return path_; }
  bool broken() const { return broken_; } // after any failure

  // HDF5's last failure, told with `what` failed; the file counts as broken.
  tl::unexpected<hal::Error> failed(std::string_view what);

  // Any thread, until finish(). To the disk; waits for it. ErrorCode::absent: the file is no longer
  // there under its name.
  hal::Result<> sync();

  // After its datasets are closed: closes it, has it marked as finished, and syncs. After a failure
  // the file is left as it was flushed last, and the Error says so.
  hal::Result<> finish(const std::function<bool(hid_t)>& mark);

private:
  GrowingFile(std::filesystem::path path, int descriptor);
  hal::Result<> check_place() const;
  Hdf5Handle open_once_more() const;

  std::filesystem::path path_;
  Descriptor descriptor_; // of the same file, to have it written to the disk
  std::atomic<bool> broken_ = false;
  Hdf5Handle file_;
};

} // namespace octascope::pipeline
