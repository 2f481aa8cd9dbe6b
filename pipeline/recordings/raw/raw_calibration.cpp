#include "pipeline/recordings/raw/raw_calibration.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pipeline/recordings/hdf5/attributes.h"
#include "pipeline/recordings/hdf5/reading.h"
#include "pipeline/recordings/raw/raw_layout.h"

namespace octascope::pipeline {

namespace {

constexpr std::array interpolations{std::pair{"linear", Interpolation::linear},
                                    std::pair{"cubic", Interpolation::cubic},
                                    std::pair{"sinc8", Interpolation::sinc8}};
constexpr std::array backgrounds{
    std::pair{"mean", BackgroundMode::mean}, std::pair{"running", BackgroundMode::running},
    std::pair{"file", BackgroundMode::file}, std::pair{"none", BackgroundMode::none}};

template <class Names, class Value> std::string name_in(const Names& names, Value value) {
  for (const auto& [name, of] : names)
    if (of == value)
      return name;
  return {};
}

template <class Names, class Value>
hal::Result<> read_named(hid_t group, const char* attribute, const Names& names, Value& value) {
  HAL_TRY(const auto found, read_text(group, attribute));
  std::string expected;
  for (const auto& [name, of] : names) {
    if (found == name) {
      value = of;
      return {};
    }
    expected += fmt::format("{}\"{}\"", expected.empty() ? "" : ", ", name);
  }
  return bad_attribute(attribute, fmt::format("found \"{}\", expected one of {}", found, expected));
}

template <class Value> hid_t native_type() {
  return std::is_same_v<Value, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT;
}

template <class Value>
bool write_curve(hid_t group, const char* name, const std::vector<Value>& curve) {
  if (curve.empty())
    return true;
  const hsize_t samples = curve.size();
  const Hdf5Handle space{H5Screate_simple(1, &samples, nullptr), H5Sclose};
  const Hdf5Handle made{
      H5Dcreate2(group, name, native_type<Value>(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose};
  return made.valid() &&
         H5Dwrite(made, native_type<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, curve.data()) >= 0;
}

// One that is not there is empty.
template <class Value>
hal::Result<> read_curve(hid_t group, const char* name, int samples, std::vector<Value>& curve) {
  if (H5Lexists(group, name, H5P_DEFAULT) <= 0)
    return {};
  hsize_t found = 0;
  HAL_TRY(const auto dataset,
          open_dataset(group, name, H5T_FLOAT, std::array<hsize_t, 1>{}, found));
  if (found != static_cast<hsize_t>(samples))
    return hal::fail(hal::ErrorCode::bad_data, "/{}/{}: found {} values, expected {}",
                     raw_layout::calibration, name, found, samples);
  curve.resize(static_cast<std::size_t>(samples));
  if (!read_rows(dataset, native_type<Value>(), std::array{found}, 0, curve.data()))
    return hal::fail(hal::ErrorCode::bad_data, "/{}/{}: cannot be read: {}",
                     raw_layout::calibration, name, hdf5_reason());
  return {};
}

} // namespace

bool write_raw_calibration(hid_t file, const Calibration& c) {
  const Hdf5Handle group{
      H5Gcreate2(file, raw_layout::calibration, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
  return group.valid() && write_curve(group, "positions", c.positions) &&
         write_curve(group, "dispersion_rad", c.dispersion_rad) &&
         write_curve(group, "background", c.background) && write_curve(group, "window", c.window) &&
         write_text(group, "camera", c.camera) &&
         write_text(group, "interpolation", name_in(interpolations, c.interpolation)) &&
         write_text(group, "background_mode", name_in(backgrounds, c.background_mode)) &&
         write_whole(group, "fixed_pattern_segments",
                     c.fixed_pattern.mode == FixedPatternMode::none ? 0
                                                                    : c.fixed_pattern.segments) &&
         write_whole(group, "zero_padding", c.zero_padding) &&
         write_real(group, "depth_spacing_um", c.depth_spacing_um) &&
         write_real(group, "refractive_index",
                    c.refractive_index.value_or(raw_layout::medium_not_said)) &&
         write_real(group, "a_spacing_um", c.a_spacing_um) &&
         write_real(group, "b_spacing_um", c.b_spacing_um) &&
         write_text(group, "assumed_spacings", c.assumed_spacings.words());
}

hal::Result<Calibration> read_raw_calibration(hid_t file, int samples) {
  const Hdf5Handle group{H5Gopen2(file, raw_layout::calibration, H5P_DEFAULT), H5Gclose};
  if (!group.valid())
    return hal::fail(hal::ErrorCode::bad_data,
                     "found no group /{}, expected one: the file is damaged, or another program "
                     "changed it",
                     raw_layout::calibration);
  Calibration c;
  c.samples = samples;
  HAL_CHECK(read_curve(group, "positions", samples, c.positions));
  HAL_CHECK(read_curve(group, "dispersion_rad", samples, c.dispersion_rad));
  HAL_CHECK(read_curve(group, "background", samples, c.background));
  HAL_CHECK(read_curve(group, "window", samples, c.window));
  HAL_CHECK(read_named(group, "interpolation", interpolations, c.interpolation));
  HAL_CHECK(read_named(group, "background_mode", backgrounds, c.background_mode));
  AttributeReader reader{group};
  reader.read("camera", c.camera);
  int segments = 0;
  reader.read("fixed_pattern_segments", segments, 0, FixedPatternRemoval::most_segments);
  reader.read("zero_padding", c.zero_padding, 1, 2);
  reader.read("depth_spacing_um", c.depth_spacing_um);
  reader.read("a_spacing_um", c.a_spacing_um);
  reader.read("b_spacing_um", c.b_spacing_um);
  std::string assumed;
  reader.read("assumed_spacings", assumed);
  if (reader.error())
    return tl::make_unexpected(*reader.error());
  if (segments > 0)
    c.fixed_pattern = {FixedPatternMode::minimum_variance, segments};
  c.assumed_spacings = AssumedSpacings::parse(assumed);
  HAL_TRY(const auto medium, read_real(group, "refractive_index"));
  if (medium >= least_refractive_index && medium <= most_refractive_index)
    c.refractive_index = medium;
  if (const auto valid = c.validate(); !valid)
    return hal::fail(hal::ErrorCode::bad_data, "/{}: {}", raw_layout::calibration,
                     valid.error().message);
  return c;
}

} // namespace octascope::pipeline
