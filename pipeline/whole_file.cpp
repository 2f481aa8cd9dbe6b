#include "pipeline/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

namespace octascope::pipeline {

namespace fs = std::filesystem;

namespace {

hal::Fault fault_of(int error) {
  switch (error) {
  case ENOENT: return hal::Fault::absent;
  case EACCES:
  case EPERM:
  case EROFS: return hal::Fault::denied;
  default: return hal::Fault::system;
  }
}

std::string words_of(int error) { return std::generic_category().message(error); }

} // namespace

hal::Result<WholeFile> WholeFile::create(const fs::path& target) {
  fs::path temporary = target;
  temporary += fmt::format(".{}.part", getpid());
  std::FILE* stream = std::fopen(temporary.c_str(), "wbx");
  if (stream == nullptr) {
    const int error = errno;
    return hal::fail(fault_of(error),
                     fmt::format("{}: cannot be written: {}; does its folder exist, and may you "
                                 "write there?",
                                 target.string(), words_of(error)));
  }
  return WholeFile{target, std::move(temporary), stream};
}

WholeFile::~WholeFile() {
  if (!stream_)
    return;
  stream_.reset();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

tl::unexpected<hal::Error> WholeFile::failure(std::string_view what) const {
  const int error = errno;
  return hal::fail(fault_of(error),
                   fmt::format("{}: {} failed: {}", target_.string(), what, words_of(error)));
}

hal::Result<> WholeFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size())
    return failure("writing");
  return {};
}

hal::Result<> WholeFile::commit() {
  if (std::ferror(stream_.get()) != 0 || std::fflush(stream_.get()) != 0)
    return failure("writing");
  if (fsync(fileno(stream_.get())) != 0)
    return failure("writing to the disk");
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
    return failure("renaming the finished file");
  stream_.reset();
  return {};
}

hal::Result<> write_whole_file(const fs::path& target, std::string_view bytes) {
  auto file = WholeFile::create(target);
  if (!file)
    return tl::make_unexpected(file.error());
  return file->write(bytes).and_then([&] { return file->commit(); });
}

} // namespace octascope::pipeline
