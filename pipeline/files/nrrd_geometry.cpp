#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "hal/number_text.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/files/nrrd_header.h"

namespace octascope::pipeline {

namespace {

using Vector = std::array<double, 3>;

struct Unit {
  std::string_view name; // in small letters, without a plural s
  double mm;
};
constexpr Unit units[] = {
    {"mm", 1},           {"millimeter", 1},    {"millimetre", 1},    {"m", 1e3},
    {"meter", 1e3},      {"metre", 1e3},       {"cm", 10},           {"centimeter", 10},
    {"centimetre", 10},  {"um", 1e-3},         {"\u00B5m", 1e-3},    {"\u03BCm", 1e-3},
    {"micron", 1e-3},    {"micrometer", 1e-3}, {"micrometre", 1e-3}, {"nm", 1e-6},
    {"nanometer", 1e-6}, {"nanometre", 1e-6},  {"in", 25.4},         {"inch", 25.4}};
constexpr std::string_view no_units[] = {"", "none", "pixel", "voxel", "???"};
constexpr std::string_view unit_words = "mm, cm, m, um, nm or in, or none";

// Handedness decides whether an array is mirrored in its space.
struct Space {
  std::string_view name;
  std::string_view abbreviation;
  bool left_handed;
};
constexpr Space spaces[] = {{"right-anterior-superior", "ras", false},
                            {"left-anterior-superior", "las", true},
                            {"left-posterior-superior", "lps", false},
                            {"scanner-xyz", "", false},
                            {"3d-right-handed", "", false},
                            {"3d-left-handed", "", true}};

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double length(const Vector& v) {
  return std::hypot(v[0], v[1], v[2]);
}

double determinant(const std::array<Vector, 3>& d) {
  return d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
         d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
         d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
}

// One "(x, y, z)" from the beginning of `text`; empty: something else.
std::optional<Vector> take_vector(std::string_view& text) {
  const auto skip_spaces = [&] {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  };
  Vector vector{};
  for (std::size_t i = 0; i < vector.size(); ++i) {
    skip_spaces();
    if (!text.starts_with(i == 0 ? '(' : ','))
      return std::nullopt;
    text.remove_prefix(1);
    skip_spaces();
    const auto number = hal::take_number<double>(text);
    if (!number || !std::isfinite(*number))
      return std::nullopt;
    vector[i] = *number;
  }
  skip_spaces();
  if (!text.starts_with(')'))
    return std::nullopt;
  text.remove_prefix(1);
  skip_spaces();
  return vector;
}

class Geometry {
public:
  Geometry(const NrrdHeader& header, std::vector<std::string>& remarks)
      : header_(header), remarks_(remarks) {}

  hal::Result<VolumeGeometry> read();

private:
  hal::Result<std::array<int, 3>> sizes() const;
  hal::Result<> check_axes() const;
  hal::Result<std::optional<Vector>> units_of(std::string_view field);
  hal::Result<std::optional<Vector>> units_of_space();
  hal::Result<bool> left_handed() const;
  hal::Result<std::optional<std::array<Vector, 3>>> directions() const;
  hal::Result<std::optional<Vector>> lengths_of_directions_mm();
  hal::Result<> check_frame(const std::array<Vector, 3>& directions) const;
  hal::Result<> remark_place(const std::array<Vector, 3>& directions);
  hal::Result<std::optional<Vector>> spacings_mm(bool beside_directions);

  const NrrdHeader& header_;
  std::vector<std::string>& remarks_;
};

hal::Result<VolumeGeometry> Geometry::read() {
  HAL_TRY(const auto counts, sizes());
  HAL_CHECK(check_axes());
  VolumeGeometry geometry{counts[0], counts[1], counts[2], 1000, 1000, 1000};
  HAL_TRY(auto lengths, lengths_of_directions_mm());
  HAL_TRY(const auto spacings, spacings_mm(lengths.has_value()));
  if (lengths && spacings)
    for (std::size_t i = 0; i < 3; ++i)
      if (std::abs((*lengths)[i] - (*spacings)[i]) > 1e-6 * (*lengths)[i])
        return header_.refuse_field("spacings",
                                    "the lengths of the space directions, or none beside them");
  const auto found = lengths ? lengths : spacings;
  if (!found) {
    for (const std::string_view field : {"axis mins", "axis maxs"})
      if (header_.find(field) != nullptr)
        return header_.refuse_field(field, "spacings or space directions instead; `unu axinfo "
                                           "-a 0 -sp SPACING` sets those of an axis");
    remarks_.emplace_back("it has neither spacings nor space directions: 1 mm is assumed for all "
                          "three axes");
    geometry.assumed = {true, true, true};
    return geometry;
  }
  constexpr double least_mm = 1e-6;
  constexpr double most_mm = 1e6;
  for (const double spacing : *found)
    if (!(spacing >= least_mm && spacing <= most_mm))
      return header_.refuse(fmt::format("the spacing {} mm", spacing),
                            fmt::format("{} to {} mm", least_mm, most_mm));
  geometry.depth_spacing_um = (*found)[0] * 1000;
  geometry.a_spacing_um = (*found)[1] * 1000;
  geometry.b_spacing_um = (*found)[2] * 1000;
  if (const std::string* words = header_.find_key(nrrd_assumed_spacings))
    geometry.assumed = AssumedSpacings::parse(*words);
  if (geometry.assumed.any())
    remarks_.push_back(
        fmt::format("its spacings are assumed, not measured: {}", geometry.assumed.words()));
  return geometry;
}

hal::Result<std::array<int, 3>> Geometry::sizes() const {
  constexpr int most = 1 << 20; // three of them stay within 64 bits
  HAL_TRY(const auto found, header_.three_numbers("sizes"));
  if (!found)
    return header_.refuse_field("sizes", "it in the header");
  std::array<int, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double size = (*found)[i];
    if (!(size >= 1 && size <= most) || size != std::floor(size))
      return header_.refuse(fmt::format("the size {}", size), fmt::format("1 to {}", most));
    counts[i] = static_cast<int>(size);
  }
  constexpr double most_voxels = 4294967296; // 16 GiB of levels
  if (const double voxels = (*found)[0] * (*found)[1] * (*found)[2]; voxels > most_voxels)
    return header_.refuse(fmt::format("{} voxels", voxels), fmt::format("at most {}", most_voxels));
  return counts;
}

// All three are axes of space, depth first.
hal::Result<> Geometry::check_axes() const {
  HAL_TRY(const auto kinds, header_.three_words("kinds"));
  if (kinds)
    for (const std::string& kind : *kinds)
      if (const std::string word = in_small_letters(kind);
          word != "domain" && word != "space" && word != "none" && word != "???" && !word.empty())
        return header_.refuse_field("kinds", "three axes of space: domain domain domain; `unu "
                                             "slice` takes one component out");
  HAL_TRY(const auto labels, header_.three_words("labels"));
  if (labels &&
      (in_small_letters((*labels)[1]) == "depth" || in_small_letters((*labels)[2]) == "depth"))
    return header_.refuse_field(
        "labels", "depth first, then A-scan, B-scan; `unu permute -p` changes the order");
  return {};
}

// Millimetres for each of three; empty: the field is not there, or says none.
hal::Result<std::optional<Vector>> Geometry::units_of(std::string_view field) {
  HAL_TRY(const auto words, header_.three_words(field));
  if (!words)
    return std::optional<Vector>{};
  Vector mm{};
  std::size_t without = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    std::string word = in_small_letters((*words)[i]);
    if (word.size() > 2 && word.ends_with('s'))
      word.pop_back();
    const auto* const found = std::ranges::find(units, word, &Unit::name);
    if (found != std::end(units))
      mm[i] = found->mm;
    else if (std::ranges::find(no_units, word) != std::end(no_units))
      ++without;
    else
      return header_.refuse_field(field, unit_words);
  }
  if (without != 0 && without != 3)
    return header_.refuse_field(field, "a unit for each axis, or none for all");
  return without == 0 ? std::optional{mm} : std::optional<Vector>{};
}

// Of the space's axes. `units` are the array's, and say the same only where they are all equal.
hal::Result<std::optional<Vector>> Geometry::units_of_space() {
  HAL_TRY(const auto of_space, units_of("space units"));
  HAL_TRY(const auto of_array, units_of("units"));
  const bool equal =
      of_array && (*of_array)[0] == (*of_array)[1] && (*of_array)[1] == (*of_array)[2];
  if (of_array && (!equal || (of_space && *of_space != *of_array)))
    return header_.refuse_field("units", "space units alone beside space directions");
  return of_space ? of_space : of_array;
}

hal::Result<bool> Geometry::left_handed() const {
  if (const std::string* dimension = header_.find("space dimension");
      dimension != nullptr && *dimension != "3")
    return header_.refuse_field("space dimension", "3");
  const std::string* text = header_.find("space");
  if (text == nullptr)
    return false;
  const std::string name = in_small_letters(*text);
  for (const Space& space : spaces)
    if (name == space.name || (!space.abbreviation.empty() && name == space.abbreviation))
      return space.left_handed;
  return header_.refuse_field("space", "left-posterior-superior, right-anterior-superior, "
                                       "left-anterior-superior, scanner-xyz, 3D-right-handed or "
                                       "3D-left-handed");
}

hal::Result<std::optional<std::array<Vector, 3>>> Geometry::directions() const {
  const std::string* text = header_.find("space directions");
  if (text == nullptr)
    return std::optional<std::array<Vector, 3>>{};
  if (header_.find("space") == nullptr && header_.find("space dimension") == nullptr)
    return header_.refuse("space directions without a space", "the field \"space\" beside them");
  std::array<Vector, 3> all{};
  std::string_view rest = *text;
  for (Vector& one : all) {
    const auto vector = take_vector(rest);
    if (!vector)
      return header_.refuse_field("space directions", "three times (x,y,z), one an axis");
    one = *vector;
  }
  if (!rest.empty())
    return header_.refuse_field("space directions", "three times (x,y,z), one an axis");
  return std::optional{all};
}

hal::Result<std::optional<Vector>> Geometry::lengths_of_directions_mm() {
  HAL_TRY(auto found, directions());
  if (!found)
    return std::optional<Vector>{};
  HAL_TRY(const auto unit, units_of_space());
  if (!unit)
    remarks_.emplace_back("its space directions have no space units: mm is assumed");
  Vector lengths{};
  for (std::size_t i = 0; i < 3; ++i) {
    Vector& direction = (*found)[i];
    if (unit)
      for (std::size_t axis = 0; axis < 3; ++axis)
        direction[axis] *= (*unit)[axis];
    lengths[i] = length(direction);
    if (!(lengths[i] > 0) || !std::isfinite(lengths[i]))
      return header_.refuse_field("space directions", "three directions that have a length");
  }
  HAL_CHECK(check_frame(*found));
  HAL_CHECK(remark_place(*found));
  return std::optional{lengths};
}

hal::Result<> Geometry::check_frame(const std::array<Vector, 3>& directions) const {
  constexpr double most_cosine = 1e-3;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector& a = directions[i];
    const Vector& b = directions[(i + 1) % 3];
    if (std::abs(dot(a, b)) > most_cosine * length(a) * length(b))
      return header_.refuse_field("space directions", "axes at right angles to each other; another "
                                                      "program has to resample it, as 3D Slicer's "
                                                      "\"Resample Scalar/Vector/DWI Volume\" does");
  }
  HAL_TRY(const bool left, left_handed());
  if ((determinant(directions) < 0) != left)
    return header_.refuse_field("space directions",
                                "axes that do not mirror the volume; `unu flip -a 2` turns the "
                                "order of the B-scans round, or correct the sign of one");
  return {};
}

// Said where the program shows or places a volume otherwise than a viewer that knows its space.
hal::Result<> Geometry::remark_place(const std::array<Vector, 3>& directions) {
  bool oblique = false;
  for (const Vector& direction : directions)
    oblique = oblique || std::ranges::count_if(direction, [&](double part) {
                           return std::abs(part) > 1e-6 * length(direction);
                         }) > 1;
  bool moved = false;
  if (const std::string* text = header_.find("space origin")) {
    std::string_view rest = *text;
    const auto origin = take_vector(rest);
    if (!origin || !rest.empty())
      return header_.refuse_field("space origin", "(x,y,z)");
    // Ours is the middle of the first voxel.
    HAL_TRY(const auto unit, units_of_space());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = (*origin)[axis] * (unit ? (*unit)[axis] : 1);
      const double middle = (directions[0][axis] + directions[1][axis] + directions[2][axis]) / 2;
      moved = moved || (place != 0 && std::abs(place - middle) > 1e-6 * std::abs(middle));
    }
  }
  if (oblique || moved)
    remarks_.push_back(fmt::format(
        "its {} not used: places, as of vessels, count from the corner of its first voxel, along "
        "its own axes",
        oblique && moved ? "space origin and the slant of its space directions are"
        : oblique        ? "space directions' slant is"
                         : "space origin is"));
  return {};
}

hal::Result<std::optional<Vector>> Geometry::spacings_mm(bool beside_directions) {
  HAL_TRY(auto found, header_.three_numbers("spacings"));
  if (!found)
    return found;
  for (const double spacing : *found)
    if (!std::isfinite(spacing) || spacing <= 0)
      return header_.refuse(fmt::format("the spacing {}", spacing), "more than 0 mm");
  HAL_TRY(const auto unit, beside_directions ? units_of_space() : units_of("units"));
  if (!unit && !beside_directions)
    remarks_.emplace_back("its spacings have no units: mm is assumed");
  for (std::size_t i = 0; unit && i < 3; ++i)
    (*found)[i] *= (*unit)[i];
  return found;
}

} // namespace

hal::Result<VolumeGeometry> nrrd_geometry(const NrrdHeader& header,
                                          std::vector<std::string>& remarks) {
  return Geometry{header, remarks}.read();
}

} // namespace octascope::pipeline
