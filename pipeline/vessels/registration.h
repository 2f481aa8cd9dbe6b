// Where a vessel tree lies in an OCT volume.
//
// The volume's frame, in mm, right-handed: x along the fast axis (A-scans), y along the slow axis
// (B-scans), z along the depth, away from the surface; the origin is the outer corner of the first
// voxel (A-scan 0, B-scan 0, depth 0). So the middle of voxel (a, b, d) is at ((a + ½)·Δa,
// (b + ½)·Δb, (d + ½)·Δd), with the spacings of VolumeGeometry and of the NRRD, whose own order of
// axes is depth, A, B. A corner rather than the centre: the scan begins there, and it stays where
// it is when a volume gets more B-scans or loses its deepest voxels.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hal/result.h"
#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/volume/patient_eye.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::pipeline {

// Of RᵀR from the identity, in any element: 1 µm in 100 mm.
inline constexpr double largest_rigid_deviation = 1e-5;

// For people.
struct RegistrationProvenance {
  std::string program; // and its version
  std::string author;
  std::string created; // date and time
  std::string method;
  std::string source;                // of the point pairs, in words
  int points = 0;                    // pairs; 0: not from points
  std::optional<double> residual_mm; // root of the mean square over the pairs

  bool operator==(const RegistrationProvenance&) const = default;
};

struct Registration {
  RigidTransform volume_from_tree; // millimetres to millimetres
  PatientEye whose;                // the vessels are, and the volume that they were registered to
  RegistrationProvenance provenance;

  // TOML:
  //   [registration]
  //   volume_from_tree = [[r, r, r, t], [r, r, r, t], [r, r, r, t], [0, 0, 0, 1]]
  //   [whose]                            # optional, each of them
  //   subject = "4711"
  //   eye = "left"
  //   [provenance]                       # optional
  //   program, author, created, method, source = "…"
  //   points = 6
  //   residual_mm = 0.02
  // Unknown keys are errors, and so is a matrix that stretches by more than
  // largest_rigid_deviation, or mirrors; the message has what was found.
  static hal::Result<Registration> load(const std::filesystem::path& file);
};

// The file appears complete or not at all; load() gives the same numbers. Faults as AtomicFile's,
// and ErrorCode::invalid_argument for a transform that load() would refuse.
hal::Result<> write_registration(const Registration& registration,
                                 const std::filesystem::path& file);

// From the volume's frame to the axes of pictures (ui/view/camera.h): origin in the middle of the
// volume, x along the fast axis, y against the depth, z along the slow axis.
RigidTransform world_from_volume(const VolumeGeometry& geometry);

} // namespace octascope::pipeline
