#include "pipeline/files/png_image.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <span>

#include <png.h>

#include "pipeline/files/input_file.h"

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

// libpng's own reader, which leaves values as they are; its simple one takes them for colours. It
// answers an error with longjmp(), so its functions are called where no destructor is passed over.
class NumberReader {
public:
  explicit NumberReader(std::span<const char> bytes)
      : rest_(bytes),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {}
  NumberReader(const NumberReader&) = delete;
  NumberReader& operator=(const NumberReader&) = delete;
  ~NumberReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // False: fault() says why.
  bool read_header(NumberImage& image);
  bool read_rows(std::span<png_bytep> rows);

  const char* fault() const { return fault_.data(); }
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }

private:
  static void on_error(png_structp png, png_const_charp message) {
    auto& self = *static_cast<NumberReader*>(png_get_error_ptr(png));
    std::snprintf(self.fault_.data(), self.fault_.size(), "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
  static void on_read(png_structp png, png_bytep to, std::size_t count) {
    auto& self = *static_cast<NumberReader*>(png_get_io_ptr(png));
    if (self.rest_.size() < count)
      png_error(png, "it ends too early");
    std::copy_n(self.rest_.data(), count, reinterpret_cast<char*>(to));
    self.rest_ = self.rest_.subspan(count);
  }

  std::span<const char> rest_;
  std::array<char, 200> fault_ = {"not enough memory"};
  png_structp png_;
  png_infop info_;
};

bool NumberReader::read_header(NumberImage& image) {
  if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0)
    return false;
  png_set_read_fn(png_, this, on_read);
  png_read_info(png_, info_);
  png_set_expand(png_);
  if (png_get_bit_depth(png_, info_) == 16)
    png_set_swap(png_); // to this machine's order
  png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
  image.width = static_cast<int>(png_get_image_width(png_, info_));
  image.height = static_cast<int>(png_get_image_height(png_, info_));
  image.channels = png_get_channels(png_, info_);
  image.greatest = png_get_bit_depth(png_, info_) == 16 ? 65535 : 255;
  return true;
}

bool NumberReader::read_rows(std::span<png_bytep> rows) {
  if (setjmp(png_jmpbuf(png_)) != 0)
    return false;
  png_read_image(png_, rows.data());
  png_read_end(png_, nullptr);
  return true;
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
  PngRecord record;
  if (png_image_begin_read_from_file(&record.png, file.c_str()) == 0)
    return record.failure(file, fs::exists(file) ? ErrorCode::bad_data : ErrorCode::absent);
  const bool grey = (record.png.format & PNG_FORMAT_FLAG_COLOR) == 0;
  record.png.format = grey ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  Image image{static_cast<int>(record.png.width), static_cast<int>(record.png.height),
              grey ? 1 : 3};
  const png_color black = {0, 0, 0};
  if (png_image_finish_read(&record.png, &black, image.pixels.data(), 0, nullptr) == 0)
    return record.failure(file, ErrorCode::bad_data);
  return image;
}

hal::Result<NumberImage> read_png_numbers(const fs::path& file, int most_pixels) {
  constexpr std::uint64_t most_bytes = 64U << 20;
  HAL_TRY(const auto input, InputFile::open(file, "a PNG picture", most_bytes));
  HAL_TRY(const auto bytes, input.read_rest(most_bytes));
  const auto refuse = [&](const char* fault) {
    return hal::fail(ErrorCode::bad_data, "{}: found no PNG picture that can be read: {}",
                     file.string(), fault);
  };
  NumberReader reader{bytes};
  NumberImage image;
  if (!reader.read_header(image))
    return refuse(reader.fault());
  if (image.width > most_pixels || image.height > most_pixels)
    return hal::fail(ErrorCode::bad_data, "{}: found {}x{} pixels, expected at most {} on a side",
                     file.string(), image.width, image.height, most_pixels);
  const std::size_t row_bytes = reader.row_bytes();
  std::vector<std::uint8_t> pixels(row_bytes * static_cast<std::size_t>(image.height));
  std::vector<png_bytep> rows;
  for (std::size_t at = 0; at < pixels.size(); at += row_bytes)
    rows.push_back(pixels.data() + at);
  if (!reader.read_rows(rows))
    return refuse(reader.fault());
  if (image.greatest == 255) {
    image.values.assign(pixels.begin(), pixels.end());
  } else {
    image.values.resize(pixels.size() / sizeof(std::uint16_t));
    std::memcpy(image.values.data(), pixels.data(), pixels.size());
  }
  return image;
}

} // namespace octascope::pipeline
