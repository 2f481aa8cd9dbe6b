#include <algorithm>
#include <bit>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "pipeline/files/nrrd.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

static_assert(std::endian::native == std::endian::little, "files are little-endian");

namespace {

std::size_t voxel_bytes(NrrdType type) {
  return type == NrrdType::uint8 ? 1 : sizeof(float);
}

// As the format has them: an end of a line within a line would end it.
std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\n')
      safe += "\\n";
    else if (c == '\\')
      safe += "\\\\";
    else
      safe += c == '\r' ? ' ' : c;
  }
  return safe;
}

std::string header(const VolumeGeometry& g, NrrdType type, const NrrdNotes& notes) {
  std::string text = "NRRD0005\n";
  const bool levels =
      std::ranges::none_of(notes, [](const auto& note) { return note.first == nrrd_content; });
  text += levels ? "# OCT volume, 20 log10(|Y|/N) of camera counts\n" : "# OCT volume\n";
  text += fmt::format("type: {}\n", type == NrrdType::uint8 ? "uint8" : "float");
  text += "dimension: 3\n";
  text += fmt::format("sizes: {} {} {}\n", g.depths, g.a_scans, g.b_scans);
  // The frame of pipeline/vessels/registration.h, whose origin is the first voxel's corner; that of
  // the format is its middle. Twelve digits: a division by 1000 leaves dust in the last of the
  // sixteen.
  const double depth = g.depth_spacing_um / 1000;
  const double a = g.a_spacing_um / 1000;
  const double b = g.b_spacing_um / 1000;
  text += "space: 3D-right-handed\n"
          "space units: \"mm\" \"mm\" \"mm\"\n";
  text += fmt::format("space directions: (0,0,{:.12g}) ({:.12g},0,0) (0,{:.12g},0)\n", depth, a, b);
  text += fmt::format("space origin: ({:.12g},{:.12g},{:.12g})\n", a / 2, b / 2, depth / 2);
  text += "kinds: domain domain domain\n"
          "labels: \"depth\" \"A-scan\" \"B-scan\"\n"
          "endian: little\n"
          "encoding: raw\n";
  if (type == NrrdType::uint8)
    text += fmt::format("lowest_level_db:={}\nlevel_step_db:={}\n", lowest_level_db, level_step_db);
  if (g.assumed.any())
    text += fmt::format("{}:={}\n", nrrd_assumed_spacings, g.assumed.words());
  if (g.refractive_index)
    text += fmt::format("refractive_index:={}\n", *g.refractive_index);
  for (const auto& [key, value] : notes)
    text += fmt::format("{}:={}\n", escaped(key), escaped(value));
  return text + "\n";
}

} // namespace

hal::Result<NrrdWriter> NrrdWriter::create(const fs::path& file, const VolumeGeometry& geometry,
                                           NrrdType type, const NrrdNotes& notes, Readers readers) {
  if (geometry.depths < 1 || geometry.a_scans < 1 || geometry.b_scans < 1)
    return hal::fail(ErrorCode::invalid_argument,
                     "{}: a volume of {}×{}×{} voxels cannot be written, expected at least 1 each",
                     file.string(), geometry.depths, geometry.a_scans, geometry.b_scans);
  for (const auto& [key, value] : notes) {
    const std::size_t bytes = escaped(key).size() + 2 + escaped(value).size();
    if (bytes > longest_nrrd_line)
      return hal::fail(ErrorCode::invalid_argument,
                       "{}: found {} bytes to note as \"{}\", expected at most {}", file.string(),
                       bytes, key, longest_nrrd_line);
  }
  HAL_TRY(auto out, AtomicFile::create(file, readers));
  const std::string text = header(geometry, type, notes);
  HAL_CHECK(out.write_at(0, std::as_bytes(std::span{text})));
  return NrrdWriter{std::move(out), geometry, type, text.size()};
}

NrrdWriter::NrrdWriter(AtomicFile file, const VolumeGeometry& geometry, NrrdType type,
                       std::size_t header_bytes)
    : file_(std::move(file)), geometry_(geometry), type_(type), header_bytes_(header_bytes) {}

hal::Result<> NrrdWriter::write_b_scan(int b, std::span<const float> levels) const {
  return write(b, NrrdType::float32, std::as_bytes(levels));
}

hal::Result<> NrrdWriter::write_b_scan(int b, std::span<const std::uint8_t> levels) const {
  return write(b, NrrdType::uint8, std::as_bytes(levels));
}

hal::Result<> NrrdWriter::write(int b, NrrdType type, std::span<const std::byte> levels) const {
  const std::size_t expected = geometry_.b_scan_voxels() * voxel_bytes(type_);
  if (type != type_ || levels.size() != expected || b < 0 || b >= geometry_.b_scans)
    return hal::fail(ErrorCode::invalid_argument,
                     "NRRD: B-scan {} with {} bytes does not belong into this volume, expected {} "
                     "bytes and 0 to {}",
                     b, levels.size(), expected, geometry_.b_scans - 1);
  return file_.write_at(header_bytes_ + expected * static_cast<std::size_t>(b), levels);
}

hal::Result<> write_nrrd(const fs::path& file, const NrrdVolume& volume) {
  const bool is_float = std::holds_alternative<std::vector<float>>(volume.levels);
  HAL_TRY(auto writer, NrrdWriter::create(file, volume.geometry,
                                          is_float ? NrrdType::float32 : NrrdType::uint8));
  const std::size_t voxels = volume.geometry.b_scan_voxels();
  return std::visit(
      [&](const auto& levels) -> hal::Result<> {
        if (levels.size() != volume.geometry.voxels())
          return hal::fail(ErrorCode::invalid_argument, "{}: found {} voxels, expected {}",
                           file.string(), levels.size(), volume.geometry.voxels());
        for (int b = 0; b < volume.geometry.b_scans; ++b) {
          const auto b_scan =
              std::span{levels}.subspan(voxels * static_cast<std::size_t>(b), voxels);
          HAL_CHECK(writer.write_b_scan(b, b_scan));
        }
        return writer.commit();
      },
      volume.levels);
}

} // namespace octascope::pipeline
