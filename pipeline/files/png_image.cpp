#include "pipeline/files/png_image.h"

#include <span>

#include <png.h>

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

// libpng's own record of an image, freed whatever happens.
struct PngRecord {
  PngRecord() { png.version = PNG_IMAGE_VERSION; }
  PngRecord(const PngRecord&) = delete;
  PngRecord& operator=(const PngRecord&) = delete;
  ~PngRecord() { png_image_free(&png); }

  tl::unexpected<hal::Error> failure(const fs::path& file, ErrorCode fault) const {
    return hal::fail(fault, "{}: {}", file.string(), png.message);
  }

  png_image png = {};
};

hal::Result<Image> read(const fs::path& file, bool with_opacity) {
  PngRecord record;
  if (png_image_begin_read_from_file(&record.png, file.c_str()) == 0)
    return record.failure(file, fs::exists(file) ? ErrorCode::bad_data : ErrorCode::absent);
  const bool grey = (record.png.format & PNG_FORMAT_FLAG_COLOR) == 0;
  const bool opacity = with_opacity && (record.png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  record.png.format = opacity ? PNG_FORMAT_RGBA : (grey ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB);
  Image image{static_cast<int>(record.png.width), static_cast<int>(record.png.height),
              opacity ? 4 : (grey ? 1 : 3)};
  const png_color black = {0, 0, 0};
  if (png_image_finish_read(&record.png, &black, image.pixels.data(), 0, nullptr) == 0)
    return record.failure(file, ErrorCode::bad_data);
  return image;
}

} // namespace

hal::Result<> write_png(const fs::path& file, const Image& image, Readers readers) {
  if (image.width < 1 || image.height < 1 || (image.channels != 1 && image.channels != 3) ||
      image.pixels.size() != Image{image.width, image.height, image.channels}.pixels.size())
    return hal::fail(ErrorCode::invalid_argument,
                     "{}: an image of {}×{} pixels with {} channels and {} bytes cannot be "
                     "written, expected 1 or 3 channels and bytes to match",
                     file.string(), image.width, image.height, image.channels, image.pixels.size());
  PngRecord record;
  record.png.width = static_cast<png_uint_32>(image.width);
  record.png.height = static_cast<png_uint_32>(image.height);
  record.png.format = image.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;

  std::vector<std::byte> encoded(PNG_IMAGE_PNG_SIZE_MAX(record.png));
  png_alloc_size_t size = encoded.size();
  if (png_image_write_to_memory(&record.png, encoded.data(), &size, 0, image.pixels.data(), 0,
                                nullptr) == 0)
    return record.failure(file, ErrorCode::system);
  HAL_TRY(auto out, AtomicFile::create(file, readers));
  HAL_CHECK(out.write_at(0, std::span{encoded}.first(size)));
  return out.commit();
}

hal::Result<Image> read_png(const fs::path& file) {
  return read(file, false);
}

hal::Result<Image> read_png_with_opacity(const fs::path& file) {
  return read(file, true);
}

} // namespace octascope::pipeline
