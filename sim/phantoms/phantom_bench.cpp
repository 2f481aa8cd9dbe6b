#include "sim/phantoms/phantom_bench.h"

#include "pipeline/calibration_finder/target.h"

namespace octascope::sim {

std::string_view BenchPhantom::name() const {
  return bench_phantom_names[static_cast<std::size_t>(subject_)];
}

std::string_view BenchPhantom::title() const {
  switch (subject_) {
  case BenchSubject::dark: return "sample arm blocked";
  case BenchSubject::mirror_near: return "near mirror";
  case BenchSubject::mirror_far: return "far mirror";
  case BenchSubject::target: break;
  }
  return "target";
}

bool BenchPhantom::reflects(float x_mm, float y_mm) const {
  if (subject_ != BenchSubject::target)
    return subject_ != BenchSubject::dark;
  const auto unit = [](float mm) {
    return (static_cast<double>(mm) / pipeline::target_side_mm + 0.5) * pipeline::target_units;
  };
  return pipeline::target_reflects(unit(x_mm), unit(y_mm));
}

void BenchPhantom::fill(Column& column, double /*phase*/, float x_mm, float y_mm) const {
  constexpr float mirror_counts = 500;
  constexpr float target_counts = 150;
  column.clear();
  if (!reflects(x_mm, y_mm))
    return;
  switch (subject_) {
  case BenchSubject::dark: return;
  case BenchSubject::mirror_near: column.add(Surface{mirror_near_mm, mirror_counts, 0}); return;
  case BenchSubject::mirror_far: column.add(Surface{mirror_far_mm, mirror_counts, 0}); return;
  case BenchSubject::target:
    column.add(Surface{0.6F + 0.05F * x_mm + 0.03F * y_mm, target_counts, 0});
  }
}

Look BenchPhantom::look(float x_mm, float y_mm) const {
  constexpr Rgb bright{0.85F, 0.86F, 0.88F};
  constexpr Rgb table{0.12F, 0.12F, 0.13F};
  return {reflects(x_mm, y_mm) ? bright : table, 0, 0.2F};
}

} // namespace octascope::sim
