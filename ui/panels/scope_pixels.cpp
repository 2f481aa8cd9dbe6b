#include "ui/panels/scope_pixels.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace octascope::ui {

namespace {

using hal::PixelFormat;

std::size_t row_bytes(const hal::ScopeFrame& frame) {
  const auto width = static_cast<std::size_t>(frame.width);
  switch (frame.format) {
  case PixelFormat::rgb8: return 3 * width;
  case PixelFormat::rgba8: return 4 * width;
  case PixelFormat::yuyv: return 4 * ((width + 1) / 2);
  case PixelFormat::nv12: return 2 * ((width + 1) / 2);
  }
  return 0;
}

std::size_t row_count(const hal::ScopeFrame& frame) {
  const auto height = static_cast<std::size_t>(frame.height);
  return frame.format == PixelFormat::nv12 ? height + (height + 1) / 2 : height;
}

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

void write_yuv(float luma, float blue, float red, std::uint8_t* rgba) {
  const float y = 1.164F * (luma - 16);
  rgba[0] = byte_of(y + 1.596F * (red - 128));
  rgba[1] = byte_of(y - 0.813F * (red - 128) - 0.392F * (blue - 128));
  rgba[2] = byte_of(y + 2.017F * (blue - 128));
  rgba[3] = 255;
}

struct Rows {
  const std::byte* luma;   // or the whole pixels
  const std::byte* chroma; // of NV12
};

void convert_row(PixelFormat format, const Rows& rows, std::size_t width, std::uint8_t* out) {
  const auto at = [](const std::byte* row, std::size_t i) {
    return std::to_integer<std::uint8_t>(row[i]);
  };
  for (std::size_t x = 0; x < width; ++x, out += 4) {
    const std::size_t pair = x / 2;
    switch (format) {
    case PixelFormat::rgb8:
    case PixelFormat::rgba8: {
      const std::size_t pixel = x * (format == PixelFormat::rgb8 ? 3 : 4);
      for (std::size_t c = 0; c < 3; ++c)
        out[c] = at(rows.luma, pixel + c);
      out[3] = 255;
      break;
    }
    case PixelFormat::yuyv:
      write_yuv(at(rows.luma, 2 * x), at(rows.luma, 4 * pair + 1), at(rows.luma, 4 * pair + 3),
                out);
      break;
    case PixelFormat::nv12:
      write_yuv(at(rows.luma, x), at(rows.chroma, 2 * pair), at(rows.chroma, 2 * pair + 1), out);
      break;
    }
  }
}

} // namespace

hal::Result<> convert_to_rgba(const hal::ScopeFrame& frame, std::span<std::uint8_t> out) {
  if (frame.width < 1 || frame.height < 1 || frame.stride_bytes < 0 ||
      static_cast<std::size_t>(frame.stride_bytes) < row_bytes(frame))
    return hal::fail(hal::Fault::bad_data,
                     fmt::format("microscope picture: {}x{} with a stride of {} bytes, expected "
                                 "a stride of at least {}",
                                 frame.width, frame.height, frame.stride_bytes, row_bytes(frame)));
  const auto stride = static_cast<std::size_t>(frame.stride_bytes);
  const std::size_t needed = stride * (row_count(frame) - 1) + row_bytes(frame);
  const auto width = static_cast<std::size_t>(frame.width);
  const auto height = static_cast<std::size_t>(frame.height);
  if (frame.pixels.size() < needed || out.size() < 4 * width * height)
    return hal::fail(hal::Fault::bad_data,
                     fmt::format("microscope picture: {} bytes for {}x{}, expected {} in and room "
                                 "for {}, found {}",
                                 frame.pixels.size(), frame.width, frame.height, needed,
                                 4 * width * height, out.size()));
  for (std::size_t y = 0; y < height; ++y) {
    const std::byte* luma = frame.pixels.data() + y * stride;
    const std::byte* chroma =
        frame.format == PixelFormat::nv12 ? frame.pixels.data() + (height + y / 2) * stride : luma;
    convert_row(frame.format, {luma, chroma}, width, out.data() + 4 * width * y);
  }
  return {};
}

} // namespace octascope::ui
