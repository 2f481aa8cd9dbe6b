#include "pipeline/files/nrrd_bytes.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>
#include <zlib.h>

namespace octascope::pipeline {

namespace {

enum class Encoding : std::uint8_t { raw, gzip };

hal::Result<Encoding> encoding_of(const NrrdHeader& header) {
  const std::string* found = header.find("encoding");
  const std::string name = found == nullptr ? "" : in_small_letters(*found);
  if (name == "raw")
    return Encoding::raw;
  if (name == "gzip" || name == "gz")
    return Encoding::gzip;
  return header.refuse_field(
      "encoding",
      "raw or gzip; `unu save -f nrrd -e gzip -i OLD -o NEW` of teem rewrites the file");
}

class RawBytes final : public NrrdBytes {
public:
  explicit RawBytes(std::span<const std::byte> data) : rest_(data) {}

  hal::Result<std::size_t> read(std::span<std::byte> bytes) override {
    const std::size_t count = std::min(bytes.size(), rest_.size());
    std::ranges::copy(rest_.first(count), bytes.begin());
    rest_ = rest_.subspan(count);
    return count;
  }

private:
  std::span<const std::byte> rest_;
};

class GzipBytes final : public NrrdBytes {
public:
  GzipBytes(const NrrdHeader& header, std::span<const std::byte> data)
      : header_(header), rest_(data) {
    constexpr int gzip_alone = 16 + MAX_WBITS;
    ended_ = inflateInit2(&stream_, gzip_alone) != Z_OK;
  }
  GzipBytes(const GzipBytes&) = delete;
  GzipBytes& operator=(const GzipBytes&) = delete;
  ~GzipBytes() override { inflateEnd(&stream_); }

  hal::Result<std::size_t> read(std::span<std::byte> bytes) override;

private:
  bool begin_next_member();

  const NrrdHeader& header_;
  std::span<const std::byte> rest_; // not yet unpacked
  z_stream stream_ = {};
  bool ended_ = false;
};

hal::Result<std::size_t> GzipBytes::read(std::span<std::byte> bytes) {
  constexpr std::size_t most_at_once = 1U << 30; // zlib counts in 32 bits
  std::size_t filled = 0;
  while (filled < bytes.size() && !rest_.empty() && !ended_) {
    const auto in = rest_.first(std::min(rest_.size(), most_at_once));
    const auto out = bytes.subspan(filled, std::min(bytes.size() - filled, most_at_once));
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(in.data()));
    stream_.avail_in = static_cast<uInt>(in.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = static_cast<uInt>(out.size());
    const int state = inflate(&stream_, Z_NO_FLUSH);
    rest_ = rest_.subspan(in.size() - stream_.avail_in);
    filled += out.size() - stream_.avail_out;
    if (state == Z_STREAM_END)
      ended_ = !begin_next_member();
    else if (state != Z_OK)
      return header_.refuse(
          fmt::format("packed data that cannot be unpacked ({})",
                      stream_.msg == nullptr ? "a piece of it is missing" : stream_.msg),
          "gzip, as encoding: gzip says");
  }
  return filled;
}

// A gzip file may hold several, one behind the other. Anything else behind one is no part of it.
bool GzipBytes::begin_next_member() {
  constexpr std::array magic{std::byte{0x1F}, std::byte{0x8B}};
  return rest_.size() >= magic.size() && std::ranges::equal(rest_.first(magic.size()), magic) &&
         inflateReset(&stream_) == Z_OK;
}

hal::Result<std::span<const std::byte>> skip_lines(const NrrdHeader& header,
                                                   std::span<const std::byte> data) {
  HAL_TRY(const auto lines, header.integer("line skip"));
  if (lines && *lines < 0)
    return header.refuse_field("line skip", "0 or more");
  for (long long line = 0; line < lines.value_or(0); ++line) {
    const auto end = std::ranges::find(data, std::byte{'\n'});
    if (end == data.end())
      return header.refuse_field("line skip",
                                 fmt::format("at most the {} lines of the data", line));
    data = data.subspan(static_cast<std::size_t>(end - data.begin()) + 1);
  }
  return data;
}

} // namespace

tl::unexpected<hal::Error> NrrdSize::refuse(const NrrdHeader& header, std::size_t found) const {
  return header.refuse(fmt::format("{} bytes of data", found), words);
}

hal::Result<std::unique_ptr<NrrdBytes>> NrrdBytes::open(const NrrdHeader& header,
                                                        std::span<const std::byte> data,
                                                        const NrrdSize& expected) {
  using Made = std::unique_ptr<NrrdBytes>;
  HAL_TRY(const auto encoding, encoding_of(header));
  HAL_TRY(auto rest, skip_lines(header, data));
  HAL_TRY(const auto said, header.integer("byte skip"));
  const long long skip = said.value_or(0);
  if (skip < -1 || (skip == -1 && encoding != Encoding::raw))
    return header.refuse_field("byte skip", "0 or more, or with encoding: raw -1, which takes the "
                                            "last bytes of the file");
  if (encoding == Encoding::raw) {
    const std::size_t behind = skip >= 0 ? static_cast<std::size_t>(skip)
                                         : rest.size() - std::min(rest.size(), expected.bytes);
    rest = rest.subspan(std::min(behind, rest.size()));
    if (rest.size() < expected.bytes)
      return expected.refuse(header, rest.size());
    return Made{std::make_unique<RawBytes>(rest)};
  }
  constexpr std::size_t most_packed = 1032; // bytes that deflate can pack into one
  const std::size_t most = rest.size() * most_packed;
  if (most < expected.bytes)
    return header.refuse(fmt::format("{} bytes of packed data", rest.size()),
                         fmt::format("at least {}, for {} unpacked",
                                     expected.bytes / most_packed + 1, expected.words));
  Made packed = std::make_unique<GzipBytes>(header, rest);
  std::array<std::byte, 4096> skipped{};
  for (auto left = static_cast<std::size_t>(skip); left > 0;) {
    HAL_TRY(const auto count,
            packed->read(std::span{skipped}.first(std::min(left, skipped.size()))));
    if (count == 0)
      return header.refuse_field("byte skip", "fewer than there are bytes of data");
    left -= count;
  }
  return packed;
}

} // namespace octascope::pipeline
