// A surgical instrument that moves through a phantom: a metal shaft with two prongs.
#pragma once

#include <array>
#include <optional>

#include "sim/phantoms/phantom_column.h"

namespace octascope::sim {

struct Point3 {
  float x_mm = 0;
  float y_mm = 0;
  float z_mm = 0;
};

struct InstrumentPath {
  Point3 hinge; // the point about which the shaft turns: the incision, outside the field
  Point3 tip;   // the tip's mean position
  Point3 reach; // half axes of the tip's closed path
  float shaft_radius_mm = 0.2F;
  float prong_radius_mm = 0.07F;
  float prong_length_mm = 1.4F;
  float opening_mm = 0.5F; // greatest distance between the prongs' ends
};

// Immutable, thread-safe. The path is a closed curve in the phase; the prongs open and close once
// along it.
class Instrument {
public:
  explicit Instrument(const InstrumentPath& path) : path_(path) {}

  struct Top {
    float depth_mm;
    float facing; // cosine between the metal's normal and the beam: 1 faces straight up
  };
  // The instrument at one moment; compute it once for many places.
  class Pose {
  public:
    // Its upper side at (x, y); empty if it is not there.
    std::optional<Top> top_at(float x_mm, float y_mm) const;
    // Bounding box: lower x, lower y, upper x, upper y.
    std::array<float, 4> bounds_mm() const;

  private:
    friend class Instrument;
    struct Rod {
      Point3 from;
      Point3 to;
      float radius_mm;
    };
    std::array<Rod, 3> rods_;
  };
  Pose pose(double phase) const;

  // Adds the metal's reflection and its shadow to a column.
  static void fill(Column& column, const Pose& pose, float x_mm, float y_mm);

private:
  InstrumentPath path_;
};

} // namespace octascope::sim
