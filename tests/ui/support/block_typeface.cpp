#include "tests/ui/support/block_typeface.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace octascope::tests {

namespace {

// A TrueType file: numbers are big-endian. Layout of the tables: the OpenType specification, 1.9.
class Bytes {
public:
  void u8(unsigned value) { bytes_.push_back(static_cast<unsigned char>(value & 0xFF)); }
  void u16(int value) {
    u8(static_cast<unsigned>(value) >> 8);
    u8(static_cast<unsigned>(value));
  }
  void u32(std::size_t value) {
    u16(static_cast<int>(value >> 16));
    u16(static_cast<int>(value & 0xFFFF));
  }
  void words(std::initializer_list<int> values) {
    for (const int value : values)
      u16(value);
  }
  void tag(std::string_view name) {
    for (const char letter : name)
      u8(static_cast<unsigned char>(letter));
  }
  void append(const Bytes& other) {
    bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
  }
  void pad_to_four() { bytes_.resize((bytes_.size() + 3) / 4 * 4); }
  std::size_t size() const { return bytes_.size(); }
  const std::vector<unsigned char>& all() const { return bytes_; }

private:
  std::vector<unsigned char> bytes_;
};

struct Range {
  int first;
  int last;
};
// The display's own words, as in ui/canvas/fonts.cpp. Glyph 0 stands for what is missing, glyph 1 is the
// blank.
constexpr std::array<Range, 4> ranges{
    {{0x20, 0xFF}, {0x2010, 0x2026}, {0x2212, 0x2212}, {0x25A1, 0x25A1}}};

constexpr int glyphs() {
  int count = 1;
  for (const Range& range : ranges)
    count += range.last - range.first + 1;
  return count;
}
static_assert(glyphs() <= 256, "eight blocks tell no more letters apart");

// In thousandths of the text's height, of which the upper 800 are over the base line.
constexpr int em = 1000;
constexpr int ascent = 800;
constexpr int advance = 480;
constexpr int column_pitch = 200;
constexpr int row_pitch = 180;
constexpr int block_height = 140;

// Two columns of four blocks: the bits of the glyph's number.
Bytes outline(int glyph, int block_width) {
  Bytes out;
  if (glyph == 1)
    return out;
  struct Block {
    int x;
    int y;
  };
  std::vector<Block> blocks;
  for (int bit = 0; bit < 8; ++bit)
    if (glyph == 0 || (glyph >> bit & 1) != 0)
      blocks.push_back({50 + bit % 2 * column_pitch, bit / 2 * row_pitch});
  const int contours = static_cast<int>(blocks.size());
  out.words({contours, 0, 0, advance, ascent}); // a generous frame
  for (int contour = 0; contour < contours; ++contour)
    out.u16(4 * contour + 3);
  out.u16(0); // no instructions
  for (int point = 0; point < 4 * contours; ++point)
    out.u8(1); // on the curve
  // From point to point, clockwise.
  int from = 0;
  for (const Block& block : blocks) {
    out.words({block.x - from, 0, block_width, 0});
    from = block.x + block_width;
  }
  from = 0;
  for (const Block& block : blocks) {
    out.words({block.y - from, block_height, 0, -block_height});
    from = block.y;
  }
  out.pad_to_four();
  return out;
}

std::vector<unsigned char> font_file(int block_width) {
  Bytes cmap;
  cmap.words({0, 1, 3, 10}); // one map, of Unicode
  cmap.u32(12);
  cmap.words({12, 0}); // in groups
  cmap.u32(16 + 12 * ranges.size());
  cmap.u32(0);
  cmap.u32(ranges.size());
  std::size_t next = 1;
  for (const Range& range : ranges) {
    cmap.u32(static_cast<std::size_t>(range.first));
    cmap.u32(static_cast<std::size_t>(range.last));
    cmap.u32(next);
    next += static_cast<std::size_t>(range.last - range.first + 1);
  }

  Bytes glyf;
  Bytes hmtx;
  Bytes loca;
  for (int glyph = 0; glyph < glyphs(); ++glyph) {
    loca.u32(glyf.size());
    hmtx.words({advance, glyph == 1 ? 0 : 50});
    glyf.append(outline(glyph, block_width));
  }
  loca.u32(glyf.size());

  Bytes head;
  head.words({1, 0, 1, 0, 0, 0, 0x5F0F, 0x3CF5, 0, em});
  head.words({0, 0, 0, 0, 0, 0, 0, 0}); // dates
  head.words({0, 0, advance, ascent, 0, 8, 2, 1, 0});

  Bytes hhea;
  hhea.words(
      {1, 0, ascent, ascent - em, 0, advance, 0, 0, advance, 1, 0, 0, 0, 0, 0, 0, 0, glyphs()});

  Bytes maxp;
  maxp.words({1, 0, glyphs(), 32, 8, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0});

  struct Table {
    std::string_view name;
    const Bytes& bytes;
  };
  const std::array<Table, 7> tables{{{"cmap", cmap},
                                     {"glyf", glyf},
                                     {"head", head},
                                     {"hhea", hhea},
                                     {"hmtx", hmtx},
                                     {"loca", loca},
                                     {"maxp", maxp}}};
  Bytes file;
  file.words({1, 0, static_cast<int>(tables.size()), 64, 2, 48});
  Bytes body;
  for (const Table& table : tables) {
    file.tag(table.name);
    file.u32(0); // FreeType looks at no checksum
    file.u32(12 + 16 * tables.size() + body.size());
    file.u32(table.bytes.size());
    body.append(table.bytes);
    body.pad_to_four();
  }
  file.append(body);
  return file.all();
}

} // namespace

ui::Typeface block_typeface() {
  static const std::vector<unsigned char> medium = font_file(130);
  static const std::vector<unsigned char> semi_bold = font_file(160);
  return {medium, semi_bold};
}

} // namespace octascope::tests
