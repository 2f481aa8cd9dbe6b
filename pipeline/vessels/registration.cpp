#include "pipeline/vessels/registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "pipeline/files/atomic_file.h"
#include "pipeline/files/config_document.h"
#include "pipeline/files/toml_text.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;

namespace {

constexpr double farthest_mm = 1e6; // of a shift: nobody's anatomy

// Of RᵀR from the identity, in the element where it is the largest.
double deviation(const RigidTransform& transform) {
  double largest = 0;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      double dot = a == b ? -1 : 0;
      for (const auto& row : transform.rotation)
        dot += row[a] * row[b];
      largest = std::max(largest, std::fabs(dot));
    }
  return largest;
}

double determinant(const RigidTransform& transform) {
  const auto& r = transform.rotation;
  return r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
         r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
         r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
}

// What is wrong with it; empty when it is rigid.
std::string fault_of(const RigidTransform& transform) {
  const double found = deviation(transform);
  if (!(found <= largest_rigid_deviation))
    return fmt::format("volume_from_tree is not rigid: its 3×3 part times its transpose deviates "
                       "from the identity by {:.3g}, expected at most {}; write more digits, or "
                       "leave out the scaling",
                       found, largest_rigid_deviation);
  if (determinant(transform) < 0)
    return "volume_from_tree mirrors (its determinant is -1), expected a turn; is one axis "
           "reversed, or are two exchanged?";
  for (const double shift : transform.shift_mm)
    if (!(std::fabs(shift) <= farthest_mm))
      return fmt::format("volume_from_tree shifts by {} mm, expected at most {} mm", shift,
                         farthest_mm);
  return {};
}

RigidTransform read_transform(ConfigTable table) {
  RigidTransform transform;
  if (!table.has("volume_from_tree")) {
    table.complain("volume_from_tree is missing, expected a matrix of 4 rows of 4 numbers");
    return transform;
  }
  const auto rows = table.rows("volume_from_tree", 4);
  if (rows.size() != 4 || rows[3] != std::vector<double>{0, 0, 0, 1}) {
    table.complain(rows.size() != 4
                       ? fmt::format("volume_from_tree has {} rows, expected 4", rows.size())
                       : "volume_from_tree's last row is another than [0, 0, 0, 1]");
    return transform;
  }
  for (std::size_t row = 0; row < 3; ++row) {
    std::copy_n(rows[row].begin(), 3, transform.rotation[row].begin());
    transform.shift_mm[row] = rows[row][3];
  }
  if (const std::string fault = fault_of(transform); !fault.empty())
    table.complain(fault);
  return transform;
}

PatientEye read_whose(ConfigTable table) {
  PatientEye whose;
  whose.subject = table.text("subject", "");
  if (!table.has("eye"))
    return whose;
  const std::string eye = table.text("eye", "");
  if (const auto named = eye_named(eye))
    whose.eye = *named;
  else
    table.complain("eye is \"{}\", expected \"left\" or \"right\"", eye);
  return whose;
}

std::string toml(const PatientEye& whose) {
  if (!whose.said())
    return {};
  std::string text = "\n[whose]\n";
  if (!whose.subject.empty())
    text += fmt::format("subject = {}\n", toml_text(whose.subject));
  if (whose.eye != Eye::not_said)
    text += fmt::format("eye = \"{}\"\n", to_string(whose.eye));
  return text;
}

RegistrationProvenance read_provenance(ConfigTable table) {
  RegistrationProvenance provenance;
  provenance.program = table.text("program", "");
  provenance.author = table.text("author", "");
  provenance.created = table.text("created", "");
  provenance.method = table.text("method", "");
  provenance.source = table.text("source", "");
  provenance.points = table.integer("points", 0, {0, std::numeric_limits<int>::max()});
  if (table.has("residual_mm"))
    provenance.residual_mm = table.number("residual_mm", 0, {0, farthest_mm});
  return provenance;
}

std::string toml(const Registration& registration) {
  const RigidTransform& t = registration.volume_from_tree;
  std::string text = "# Where a vessel tree lies in an OCT volume. The volume's frame: mm, origin "
                     "at the outer corner\n# of the first voxel, x along A-scans, y along B-scans, "
                     "z along the depth.\n[registration]\nvolume_from_tree = [\n";
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& r = t.rotation[row];
    text += fmt::format("  {},\n", toml_numbers({r[0], r[1], r[2], t.shift_mm[row]}));
  }
  const RegistrationProvenance& p = registration.provenance;
  text += fmt::format("  {},\n]\n{}\n[provenance]\nprogram = {}\nauthor = {}\ncreated = {}\n"
                      "method = {}\nsource = {}\npoints = {}\n",
                      toml_numbers({0, 0, 0, 1}), toml(registration.whose), toml_text(p.program),
                      toml_text(p.author), toml_text(p.created), toml_text(p.method),
                      toml_text(p.source), p.points);
  if (p.residual_mm)
    text += fmt::format("residual_mm = {:.9g}\n", *p.residual_mm);
  return text;
}

} // namespace

hal::Result<Registration> Registration::load(const fs::path& file) {
  HAL_TRY(auto document, ConfigDocument::load(file));
  Registration registration;
  registration.volume_from_tree = read_transform(document.root().table("registration"));
  registration.whose = read_whose(document.root().table("whose"));
  registration.provenance = read_provenance(document.root().table("provenance"));
  HAL_CHECK(document.finish());
  return registration;
}

hal::Result<> write_registration(const Registration& registration, const fs::path& file) {
  if (const std::string fault = fault_of(registration.volume_from_tree); !fault.empty())
    return hal::fail(hal::ErrorCode::invalid_argument, "{}: {}", file.string(), fault);
  HAL_TRY(auto out, AtomicFile::create(file));
  const std::string text = toml(registration);
  HAL_CHECK(out.write_at(0, std::as_bytes(std::span{text})));
  return out.commit();
}

RigidTransform world_from_volume(const VolumeGeometry& geometry) {
  RigidTransform world;
  world.rotation = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
  world.shift_mm = {-geometry.a_mm() / 2, geometry.depth_mm() / 2, -geometry.b_mm() / 2};
  return world;
}

} // namespace octascope::pipeline
