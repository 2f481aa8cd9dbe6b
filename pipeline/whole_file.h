// Files that appear whole or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

#include "hal/result.h"

namespace octascope::pipeline {

// Writes to a temporary file beside `target` and renames it over the target in commit(). Without a
// commit, or after an error, nothing remains. One thread.
class WholeFile {
public:
  static hal::Result<WholeFile> create(const std::filesystem::path& target);
  ~WholeFile();
  WholeFile(WholeFile&&) noexcept = default;
  WholeFile& operator=(WholeFile&&) = delete;

  // For libraries that write to a stream of the C library; errors of it show in commit().
  std::FILE* stream() { return stream_.get(); }

  hal::Result<> write(std::string_view bytes);

  // Flushes to the disk and renames.
  hal::Result<> commit();

private:
  struct Close {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  WholeFile(std::filesystem::path target, std::filesystem::path temporary, std::FILE* stream)
      : target_(std::move(target)), temporary_(std::move(temporary)), stream_(stream) {}
  tl::unexpected<hal::Error> failure(std::string_view what) const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::unique_ptr<std::FILE, Close> stream_; // null once committed
};

hal::Result<> write_whole_file(const std::filesystem::path& target, std::string_view bytes);

} // namespace octascope::pipeline
