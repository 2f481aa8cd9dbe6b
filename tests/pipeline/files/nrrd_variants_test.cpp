// NRRD files as other programs write them: geometry, units, number types, encodings, detached data.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "pipeline/files/nrrd.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::FailsSaying;

constexpr std::string_view no_remark{};

// Two depths, three A-scans, two B-scans.
constexpr std::string_view shape = "NRRD0005\ndimension: 3\nsizes: 2 3 2\n";
constexpr std::size_t voxels = 12;

hal::Result<NrrdVolume> parse(std::string_view text) {
  return parse_nrrd(std::as_bytes(std::span{text}), "v.nrrd");
}

hal::Result<NrrdVolume> parse_with(std::string_view fields) {
  return parse(
      fmt::format("{}type: uint8\nencoding: raw\n{}\n{}", shape, fields, std::string(voxels, 'x')));
}

struct Placed {
  std::string fields;
  std::vector<double> spacings_um;
  std::string_view remark = no_remark;
};

TEST(NrrdGeometry, is_read_however_it_is_written) {
  const std::string lps = "space: left-posterior-superior\n";
  const std::string straight = "space directions: (0.002,0,0) (0,0.03,0) (0,0,0.05)\n";
  const std::vector<double> expected{2, 30, 50};
  const Placed all[] = {
      {"spacings: 0.002 0.03 0.05\nunits: \"mm\" \"mm\" \"mm\"\n", expected},
      {"Spacings: 2 30 50\nUnits: \"um\" \"\u00B5m\" \"\u03BCm\"\n", expected},
      {"spacings: 2 3e-5 5e-3\nunits: \"micrometers\" \"m\" \"cm\"\n", expected},
      {"spacings: 2000 0.03 50\nunits: \"NM\" \"Millimetre\" \"micron\"\n", expected},
      {"spacings: 0.002 0.03 0.05\n", expected, "no units: mm is assumed"},
      {"spacings: 0.002 0.03 0.05\nunits: \"pixel\" \"\" \"none\"\n", expected,
       "no units: mm is assumed"},
      {"space: RAS\nspace units: \"mm\" \"mm\" \"mm\"\n" + straight, expected},
      {"space dimension: 3\nspace units: \"mm\" \"mm\" \"mm\"\nspace origin: (0,0,0)\n" + straight,
       expected},
      {lps + straight, expected, "no space units: mm is assumed"},
      // The units of the space's axes, not of the array's.
      {"space: scanner-xyz\nspace units: \"m\" \"um\" \"mm\"\n"
       "space directions: (0,2,0) (0,0,0.03) ( 5e-5 , 0 , 0 )\n",
       expected},
      {lps + "units: \"um\" \"um\" \"um\"\nspace directions: (2,0,0) (0,-30,0) (0,0,-50)\n",
       expected},
      {lps + "space units: \"mm\" \"mm\" \"mm\"\nspacings: 0.002 0.03 0.05\n" + straight, expected},
      // Turned by the angle of 3, 4, 5.
      {lps + "space units: \"mm\" \"mm\" \"mm\"\n"
             "space directions: (0,0.002,0) (0.018,0,0.024) (0.04,0,-0.03)\n",
       expected, "slant"},
      {lps + "space units: \"mm\" \"mm\" \"mm\"\nspace origin: (7,-8,9)\n" + straight, expected,
       "space origin is not used"},
      {"space: 3D-left-handed\nspace units: \"mm\" \"mm\" \"mm\"\n"
       "space directions: (0.002,0,0) (0,0.03,0) (0,0,-0.05)\n",
       expected},
      {"", {1000, 1000, 1000}, "1 mm is assumed"},
  };
  for (const Placed& one : all) {
    const auto read = parse_with(one.fields);
    ASSERT_TRUE(read) << one.fields << read.error().message;
    const VolumeGeometry& g = read->geometry;
    const double found[] = {g.depth_spacing_um, g.a_spacing_um, g.b_spacing_um};
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found[i], one.spacings_um[i], 1e-9 * found[i]) << one.fields << i;
    if (one.remark == no_remark)
      EXPECT_THAT(read->remarks, IsEmpty()) << one.fields;
    else
      EXPECT_THAT(read->remarks, ElementsAre(HasSubstr(one.remark))) << one.fields;
  }
}

struct Refused {
  std::string fields;
  std::string_view says;
};

TEST(NrrdGeometry, that_cannot_be_placed_is_refused_by_name) {
  const std::string lps = "space: LPS\n";
  const std::string directions = "space directions: (0.002,0,0) (0,0.03,0) (0,0,0.05)\n";
  const Refused all[] = {
      {"spacings: 1 1 1\nunits: \"furlong\" \"mm\" \"mm\"\n", "units: \"furlong\""},
      {"spacings: 1 1 1\nunits: \"mm\" \"mm\" \"\"\n", "a unit for each axis"},
      {"spacings: 1 1 1\nunits: \"mm\" \"mm\"\n", "expected three words"},
      {"spacings: 1 1 1\nunits: \"mm\" \"mm\" \"mm\n", "expected three words"},
      {"spacings: 1 0 1\n", "the spacing 0"},
      {"spacings: 1 -1 1\n", "the spacing -1"},
      {"spacings: 1 1e300 1\n", "expected 1e-06 to 1000000 mm"},
      {"axis mins: 0 0 0\naxis maxs: 1 1 1\n", "axis mins: 0 0 0"},
      {directions, "without a space"},
      {lps + "space directions: none (0,1,0) (0,0,1)\n", "three times (x,y,z)"},
      {lps + "space directions: (1,0) (0,1) (0,0)\n", "three times (x,y,z)"},
      {lps + "space directions: (1,0,0) (0,1,0) (0,0,1) (0,0,0)\n", "three times (x,y,z)"},
      {lps + "space directions: (1,0,0) (0,nan,0) (0,0,1)\n", "three times (x,y,z)"},
      {lps + "space directions: (0,0,0) (0,1,0) (0,0,1)\n", "that have a length"},
      {lps + "space directions: (1,0,0) (0.1,1,0) (0,0,1)\n", "at right angles"},
      {lps + "space directions: (1,0,0) (0,1,0) (0,0,-1)\n", "unu flip"},
      {lps + "space directions: (0,1,0) (1,0,0) (0,0,1)\n", "do not mirror"},
      {"space: left-anterior-superior\n" + directions, "do not mirror"},
      {"space: outer\n" + directions, "space: outer"},
      {"space dimension: 4\n" + directions, "space dimension: 4"},
      {lps + "space origin: (0,0)\n" + directions, "space origin: (0,0)"},
      {lps + "space units: \"ly\" \"ly\" \"ly\"\n" + directions, "space units: \"ly\""},
      {lps + "units: \"um\" \"mm\" \"mm\"\n" + directions, "space units alone"},
      {lps + "spacings: 0.002 0.03 0.06\n" + directions, "lengths of the space directions"},
      {"kinds: RGB-color domain domain\n", "kinds: RGB-color"},
      {"labels: \"A-scan\" \"depth\" \"B-scan\"\n", "unu permute"},
  };
  for (const Refused& one : all)
    EXPECT_THAT(parse_with(one.fields), FailsSaying(std::string{one.says})) << one.fields;
}

template <class Value> std::string bytes_of(const std::vector<int>& values, bool big = false) {
  std::string bytes;
  for (const int value : values) {
    const auto as_stored = static_cast<Value>(value);
    std::string one(reinterpret_cast<const char*>(&as_stored), sizeof(Value));
    if (big)
      std::ranges::reverse(one);
    bytes += one;
  }
  return bytes;
}

std::string packed(std::string_view bytes) {
  z_stream stream = {};
  deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

const std::vector<int> levels_db{0, 1, 2, 10, 20, 30, 40, 50, 60, 70, 80, 127};

hal::Result<NrrdVolume> parse_data(const std::string& fields, const std::string& data) {
  return parse(
      fmt::format("{}spacings: 1 1 1\nunits: \"mm\" \"mm\" \"mm\"\n{}\n{}", shape, fields, data));
}

void expect_levels(const hal::Result<NrrdVolume>& read, const std::string& what) {
  ASSERT_TRUE(read) << what << read.error().message;
  EXPECT_EQ(std::get<std::vector<float>>(read->levels),
            std::vector<float>(levels_db.begin(), levels_db.end()))
      << what;
}

struct NamedType {
  std::string names;
  std::string (*bytes)(const std::vector<int>&, bool);
};

TEST(NrrdData, is_read_in_every_type_order_and_encoding) {
  const NamedType all[] = {
      {"int8|int8_t|signed char|Signed Char", bytes_of<std::int8_t>},
      {"int16|int16_t|short|short int|signed short|signed short int", bytes_of<std::int16_t>},
      {"uint16|uint16_t|ushort|unsigned short|unsigned short int", bytes_of<std::uint16_t>},
      {"int32|int32_t|int|signed int", bytes_of<std::int32_t>},
      {"uint32|uint32_t|uint|unsigned int", bytes_of<std::uint32_t>},
      {"int64|int64_t|longlong|long long|long long int|signed long long|signed long long int",
       bytes_of<std::int64_t>},
      {"uint64|uint64_t|ulonglong|unsigned long long|unsigned long long int",
       bytes_of<std::uint64_t>},
      {"float", bytes_of<float>},
      {"double|DOUBLE", bytes_of<double>}};
  for (const NamedType& type : all)
    for (std::size_t at = 0; at < type.names.size();) {
      const std::string name = type.names.substr(at, type.names.find('|', at) - at);
      at += name.size() + 1;
      for (const bool big : {false, true}) {
        const std::string fields =
            fmt::format("type: {}\nendian: {}\n", name, big ? "Big" : "little");
        const std::string bytes = type.bytes(levels_db, big);
        expect_levels(parse_data(fields + "encoding: raw\n", bytes), fields);
        expect_levels(parse_data(fields + "encoding: gzip\n", packed(bytes)), fields);
        const std::size_t half = bytes.size() / 2; // gzip of several members is one
        expect_levels(parse_data(fields + "encoding: GZ\n",
                                 packed(bytes.substr(0, half)) + packed(bytes.substr(half))),
                      fields);
      }
    }
}

TEST(NrrdData, of_8_bits_are_the_display_s_counts_unless_the_header_says_otherwise) {
  const std::string bytes = bytes_of<std::uint8_t>(levels_db);
  for (const char* name : {"uint8", "uint8_t", "uchar", "unsigned char"}) {
    const auto read = parse_data(fmt::format("type: {}\nencoding: raw\n", name), bytes);
    ASSERT_TRUE(read) << name;
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(read->levels),
              std::vector<std::uint8_t>(levels_db.begin(), levels_db.end()));
  }
  const auto eighth = [&](const std::string& fields, const std::string& data) {
    const auto read = parse_data(fields, data);
    EXPECT_TRUE(read) << fields << (read ? "" : read.error().message);
    return read ? std::get<std::vector<float>>(read->levels)[7] : 0; // the value 50
  };
  const std::string keys = "lowest_level_db:=-40\nlevel_step_db:=0.5\n";
  EXPECT_EQ(
      eighth("type: float\nendian: little\nencoding: raw\n" + keys, bytes_of<float>(levels_db)),
      -15);
  EXPECT_EQ(eighth("type: uint8\nencoding: raw\nlowest_level_db:=-60\nlevel_step_db:=2\n", bytes),
            40);
  // As `unu quantize -b 8 -min -28 -max 100` has it, and `unu unquantize` takes it back.
  EXPECT_FLOAT_EQ(eighth("type: uint8\nencoding: raw\nold min: -28\nold max: 100\n", bytes),
                  -28 + 50.5F * 0.5F);
  EXPECT_FLOAT_EQ(
      eighth("type: ushort\nendian: little\nencoding: raw\nold min: 0\nold max: 65536\n",
             bytes_of<std::uint16_t>(levels_db)),
      50.5F);
  for (const char* bad : {"old min: 1\n", "old min: 1\nold max: x\n", "level_step_db:=wide\n"})
    EXPECT_FALSE(parse_data(std::string{"type: uint8\nencoding: raw\n"} + bad, bytes)) << bad;
}

struct Skipping {
  std::string fields;
  std::string before;
  std::string behind;
  std::string_view remark = no_remark;
};

TEST(NrrdData, lies_where_the_header_says) {
  const std::string bytes = bytes_of<std::int16_t>(levels_db);
  const std::string type = "type: short\nendian: little\n";
  const Skipping all[] = {
      {"encoding: raw\nbyte skip: 5\n", "12345", ""},
      {"encoding: raw\nbyteskip: -1\n", "of any length", ""},
      {"encoding: raw\nLine Skip: 2\nbyte skip: 1\n", "P5\n12 1\nx", ""},
      {"encoding: raw\n", "", "\r\n", "2 bytes behind the volume"},
  };
  for (const Skipping& one : all) {
    const auto read = parse_data(type + one.fields, one.before + bytes + one.behind);
    expect_levels(read, one.fields);
    EXPECT_EQ(read->remarks.size(), one.remark == no_remark ? 0U : 1U) << one.fields;
  }
  const std::string gzip = type + "encoding: gzip\n";
  expect_levels(
      parse_data(gzip + "line skip: 1\nbyte skip: 3\n", "a line\n" + packed("abc" + bytes)),
      "gzip");
  EXPECT_THAT(parse_data(gzip, packed(bytes) + "no gzip")->remarks, IsEmpty());
  EXPECT_THAT(parse_data(gzip, packed(bytes + "more"))->remarks,
              ElementsAre(HasSubstr("4 bytes behind")));
}

TEST(NrrdData, that_is_not_what_the_header_says_is_refused) {
  const std::string bytes = bytes_of<std::int16_t>(levels_db);
  const std::string type = "type: short\nendian: little\n";
  const auto refusal = [&](const std::string& fields, const std::string& data) {
    return tests::error_of(parse_data(type + fields, data)).message;
  };
  EXPECT_THAT(refusal("encoding: raw\n", bytes.substr(1)), HasSubstr("found 23 bytes of data"));
  EXPECT_THAT(refusal("encoding: raw\n", bytes + std::string(12, 'x')), HasSubstr("more B-scans"));
  EXPECT_THAT(refusal("encoding: raw\nbyte skip: 9223372036854775807\n", bytes),
              HasSubstr("found 0 bytes"));
  EXPECT_THAT(refusal("encoding: raw\nbyte skip: -2\n", bytes), HasSubstr("byte skip: -2"));
  EXPECT_THAT(refusal("encoding: raw\nbyte skip: 1e3\n", bytes), HasSubstr("a whole number"));
  EXPECT_THAT(refusal("encoding: raw\nline skip: 99\n", bytes), HasSubstr("line skip: 99"));
  EXPECT_THAT(refusal("encoding: raw\nline skip: -1\n", bytes), HasSubstr("line skip: -1"));
  EXPECT_THAT(refusal("encoding: gzip\n", bytes), HasSubstr("cannot be unpacked"));
  EXPECT_THAT(refusal("encoding: gzip\nbyte skip: -1\n", bytes), HasSubstr("byte skip: -1"));
  EXPECT_THAT(refusal("encoding: gzip\nbyte skip: 99\n", packed(bytes)),
              HasSubstr("byte skip: 99"));
  EXPECT_THAT(refusal("encoding: gzip\n", packed(bytes).substr(0, 30)), HasSubstr("bytes of data"));
  EXPECT_THAT(refusal("encoding: gzip\n", packed(bytes + std::string(1 << 20, 'x'))),
              HasSubstr("more B-scans"));
  std::string spoilt = packed(bytes);
  spoilt[spoilt.size() - 6] = static_cast<char>(~spoilt[spoilt.size() - 6]);
  EXPECT_THAT(refusal("encoding: gzip\n", spoilt), HasSubstr("cannot be unpacked"));
  for (const char* encoding : {"ascii", "hex", "bzip2"})
    EXPECT_THAT(refusal(fmt::format("encoding: {}\n", encoding), bytes),
                testing::AllOf(HasSubstr(encoding), HasSubstr("raw or gzip"), HasSubstr("unu")));
}

// Before it is allocated, a volume is held against what is there.
TEST(NrrdData, claims_no_memory_that_the_file_cannot_fill) {
  const auto refusal = [](std::string_view sizes, std::string_view encoding) {
    return tests::error_of(parse(fmt::format("NRRD0001\ntype: double\ndimension: 3\nsizes: {}\n"
                                             "endian: little\nencoding: {}\n\n{}",
                                             sizes, encoding, packed("x"))))
        .message;
  };
  EXPECT_THAT(refusal("1048576 1048576 1048576", "raw"), HasSubstr("voxels, expected at most"));
  EXPECT_THAT(refusal("1048577 1 1", "raw"), HasSubstr("the size 1048577"));
  EXPECT_THAT(refusal("1.5 1 1", "raw"), HasSubstr("the size 1.5"));
  EXPECT_THAT(refusal("1000 1000 1000", "raw"), HasSubstr("expected 8000000000"));
  EXPECT_THAT(refusal("1000 1000 1000", "gzip"), HasSubstr("bytes of packed data"));
}

class DetachedNrrd : public testing::Test {
protected:
  hal::Result<NrrdVolume> read(std::string_view data_file, std::string_view end = "") {
    return read_nrrd(folder.write(
        "v.nhdr", fmt::format("{}type: int16\nendian: little\nencoding: raw\nspacings: 1 1 1\n"
                              "units: \"mm\" \"mm\" \"mm\"\ndata file: {}{}",
                              shape, data_file, end)));
  }
  tests::ScratchFolder folder;
  std::string data = bytes_of<std::int16_t>(levels_db);
};

TEST_F(DetachedNrrd, data_is_found_beside_its_header) {
  folder.write("v.raw", data);
  folder.write("my volume.raw", data);
  std::filesystem::create_directory(folder / "deeper");
  folder.write("deeper/v.raw", data);
  for (const char* end : {"", "\n", "\r\n", "\n\n"})
    expect_levels(read("v.raw", end), end);
  expect_levels(read("./my volume.raw"), "with a space");
  expect_levels(read("deeper/v.raw"), "deeper");
  expect_levels(read((folder / "v.raw").string()), "absolute");
}

TEST_F(DetachedNrrd, data_that_is_no_file_is_refused) {
  folder.write("empty", "");
  EXPECT_THAT(read("none.raw"), tests::FailsWith(hal::ErrorCode::absent));
  EXPECT_THAT(read("none.raw"), FailsSaying("none.raw: cannot be opened: No such file"));
  EXPECT_THAT(read("none.raw"), FailsSaying("v.nhdr"));
  EXPECT_THAT(read("."), FailsSaying("is a directory"));
  EXPECT_THAT(read("/dev/zero"), FailsSaying("not a regular file"));
  EXPECT_THAT(read("empty"), FailsSaying("is empty"));
  EXPECT_THAT(read("LIST", "\na.raw\nb.raw\n"), FailsSaying("data file"));
  EXPECT_THAT(read("LIST"), FailsSaying("one file"));
  EXPECT_THAT(read("v%03d.raw 1 2 1"), FailsSaying("one file"));
  EXPECT_THAT(parse(fmt::format("{}data file: v.raw\n\n", shape)),
              FailsSaying("behind the header"));
}

TEST(NrrdHeaderText, comes_from_many_editors) {
  const std::string data(voxels, 'x');
  const std::string fields = "type: uint8\ndimension: 3\nsizes: 2 3 2\nencoding: raw\n"
                             "spacings: 1 1 1\nunits: mm mm mm\n";
  std::string dos = "NRRD0004\n# a comment\ncontent: a: b\nkey:=value: x\n" + fields + "\n";
  for (std::size_t at = 0; (at = dos.find('\n', at)) != std::string::npos; at += 2)
    dos.insert(at, 1, '\r');
  EXPECT_TRUE(parse(dos + data));
  EXPECT_TRUE(parse("\xEF\xBB\xBFNRRD0001\n" + fields + "\n" + data));
  for (const char* bad : {"NRRD0006\n", "NRRD0000\n", "NRRD\n", ""})
    EXPECT_THAT(parse(bad + fields + "\n" + data), FailsSaying("no NRRD magic")) << bad;
  EXPECT_THAT(parse("NRRD0005\nSizes: 1 1 1\n" + fields + "\n" + data), FailsSaying("twice"));
  EXPECT_THAT(parse("NRRD0005\n" + fields + "nonsense\n\n" + data), FailsSaying("nonsense"));
}

} // namespace
} // namespace octascope::pipeline
