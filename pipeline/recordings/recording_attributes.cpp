#include "pipeline/recordings/recording_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "pipeline/recordings/recording_layout.h"
#include "pipeline/recordings/variable_text.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::pipeline {

namespace {

constexpr std::size_t longest_text = std::size_t{1} << 20; // in a file that somebody else made
constexpr std::int64_t largest_size = 65536;               // of an axis

// Text is UTF-8 of its own length, at least one byte: HDF5 knows no empty one.
bool write_text(hid_t file, const char* name, const std::string& text) {
  const Hdf5Handle type{H5Tcopy(H5T_C_S1), H5Tclose};
  if (H5Tset_size(type, std::max<std::size_t>(text.size(), 1)) < 0 ||
      H5Tset_cset(type, H5T_CSET_UTF8) < 0 || H5Tset_strpad(type, H5T_STR_NULLPAD) < 0)
    return false;
  const Hdf5Handle space{H5Screate(H5S_SCALAR), H5Sclose};
  const Hdf5Handle attribute{H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose};
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  return attribute.valid() && H5Awrite(attribute, type, padded.data()) >= 0;
}

bool write_number(hid_t file, const char* name, hid_t stored, hid_t native, const void* value) {
  const Hdf5Handle space{H5Screate(H5S_SCALAR), H5Sclose};
  const bool there = H5Aexists(file, name) > 0;
  const Hdf5Handle attribute{there
                                 ? H5Aopen(file, name, H5P_DEFAULT)
                                 : H5Acreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose};
  return attribute.valid() && H5Awrite(attribute, native, value) >= 0;
}

bool write_whole(hid_t file, const char* name, std::int64_t value) {
  return write_number(file, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

bool write_real(hid_t file, const char* name, double value) {
  return write_number(file, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

tl::unexpected<hal::Error> bad(const char* name, const std::string& what) {
  return hal::fail(hal::ErrorCode::bad_data, "attribute {}: {}", name, what);
}

// A scalar attribute, and its type.
struct FoundAttribute {
  Hdf5Handle attribute;
  Hdf5Handle type;
};

// `takes`: of which classes it may be.
hal::Result<FoundAttribute> find(hid_t file, const char* name,
                                 std::initializer_list<H5T_class_t> takes, const char* expected) {
  FoundAttribute found;
  found.attribute = Hdf5Handle{H5Aopen(file, name, H5P_DEFAULT), H5Aclose};
  if (!found.attribute.valid())
    return bad(name, fmt::format("found none, expected {}", expected));
  found.type = Hdf5Handle{H5Aget_type(found.attribute), H5Tclose};
  const H5T_class_t type_class = H5Tget_class(found.type);
  if (std::ranges::find(takes, type_class) == takes.end())
    return bad(name, fmt::format("found {}, expected {}", name_of(type_class), expected));
  const Hdf5Handle space{H5Aget_space(found.attribute), H5Sclose};
  if (const hssize_t count = H5Sget_simple_extent_npoints(space); count != 1)
    return bad(name, fmt::format("found {} values, expected {}", count, expected));
  return found;
}

// Filled up as the file's type says.
hal::Result<std::string> read_fixed_text(const FoundAttribute& found) {
  const std::size_t size = H5Tget_size(found.type);
  if (size == 0 || size > longest_text)
    return hal::fail(hal::ErrorCode::bad_data, "found a text of {} bytes, expected at most {}",
                     size, longest_text);
  std::string text(size, '\0');
  if (H5Aread(found.attribute, found.type, text.data()) < 0)
    return hal::fail(hal::ErrorCode::bad_data, "cannot be read: " + hdf5_reason());
  if (H5Tget_strpad(found.type) == H5T_STR_SPACEPAD)
    text.resize(text.find_last_not_of(' ') + 1);
  return text;
}

hal::Result<std::string> read_text(hid_t file, const char* name) {
  HAL_TRY(const auto found, find(file, name, {H5T_STRING}, "a text"));
  const auto text = H5Tis_variable_str(found.type) > 0
                        ? read_variable_text(found.attribute, longest_text)
                        : read_fixed_text(found);
  if (!text)
    return bad(name, text.error().message);
  return text->substr(0, text->find('\0'));
}

// Other programs write truth as an enumeration.
hal::Result<std::int64_t> read_whole(hid_t file, const char* name) {
  HAL_TRY(const auto found, find(file, name, {H5T_INTEGER, H5T_ENUM}, "a whole number"));
  std::int64_t value = 0;
  if (H5Aread(found.attribute, H5T_NATIVE_INT64, &value) < 0)
    return bad(name, "cannot be read: " + hdf5_reason());
  return value;
}

hal::Result<double> read_real(hid_t file, const char* name) {
  HAL_TRY(const auto found, find(file, name, {H5T_FLOAT, H5T_INTEGER}, "a number"));
  double value = 0;
  if (H5Aread(found.attribute, H5T_NATIVE_DOUBLE, &value) < 0)
    return bad(name, "cannot be read: " + hdf5_reason());
  return value;
}

hal::Result<> expect(hid_t file, const char* name, double expected) {
  HAL_TRY(const auto value, read_real(file, name));
  if (value != expected)
    return bad(name, fmt::format("found {}, expected {}", value, expected));
  return {};
}

hal::Result<> check_format(hid_t file) {
  const auto format = read_text(file, "format");
  if (!format)
    return hal::fail(hal::ErrorCode::bad_data, "is no recording of octascope: {}",
                     format.error().message);
  if (*format != recording_layout::format_name)
    return hal::fail(hal::ErrorCode::bad_data,
                     "is no recording of octascope: found the format \"{}\", expected \"{}\"",
                     *format, recording_layout::format_name);
  HAL_TRY(const auto version, read_whole(file, "format_version"));
  if (version != recording_layout::format_version)
    return bad("format_version", fmt::format("found {}, this program reads {}", version,
                                             recording_layout::format_version));
  for (const auto& [name, value] :
       {std::pair{"lowest_level_db", lowest_level_db}, std::pair{"level_step_db", level_step_db}})
    HAL_CHECK(expect(file, name, static_cast<double>(value)));
  return {};
}

// In the place of a refractive index.
constexpr double medium_not_said = 0;

// Reads one attribute after the other until one is wrong.
class FactReader {
public:
  explicit FactReader(hid_t file) : file_(file) {}

  void read(const char* name, std::string& value) {
    take(value, [&] { return read_text(file_, name); });
  }
  void read(const char* name, int& value) {
    std::int64_t whole = 0;
    take(whole, [&] { return read_whole(file_, name); });
    if (!error_ && (whole < 1 || whole > largest_size))
      error_ = bad(name, fmt::format("found {}, expected 1 to {}", whole, largest_size)).value();
    value = static_cast<int>(whole);
  }
  void read(const char* name, bool& value) {
    std::int64_t whole = 0;
    take(whole, [&] { return read_whole(file_, name); });
    value = whole != 0;
  }
  void read(const char* name, double& value) {
    take(value, [&] { return read_real(file_, name); });
    if (!error_ && !(std::isfinite(value) && value > 0))
      error_ = bad(name, fmt::format("found {}, expected more than zero", value)).value();
  }
  // Older recordings do not have it.
  void read_if_there(const char* name, std::string& value) {
    if (H5Aexists(file_, name) > 0)
      read(name, value);
  }
  void read(const char* name, std::optional<double>& value) {
    if (error_ || H5Aexists(file_, name) <= 0)
      return;
    double said = medium_not_said;
    take(said, [&] { return read_real(file_, name); });
    if (error_ || said == medium_not_said)
      return;
    if (said >= least_refractive_index && said <= most_refractive_index)
      value = said;
    else
      error_ =
          bad(name, fmt::format("found {}, expected {} to {}, or {}", said, least_refractive_index,
                                most_refractive_index, medium_not_said))
              .value();
  }
  const std::optional<hal::Error>& error() const { return error_; }

private:
  template <typename T> void take(T& value, auto&& read_it) {
    if (error_)
      return;
    if (auto got = read_it())
      value = std::move(*got);
    else
      error_ = got.error();
  }

  hid_t file_;
  std::optional<hal::Error> error_;
};

} // namespace

bool write_facts(hid_t file, const RecordingFacts& facts) {
  const VolumeGeometry& g = facts.geometry;
  return write_text(file, "format", recording_layout::format_name) &&
         write_whole(file, "format_version", recording_layout::format_version) &&
         write_real(file, "lowest_level_db", static_cast<double>(lowest_level_db)) &&
         write_real(file, "level_step_db", static_cast<double>(level_step_db)) &&
         write_whole(file, "depths", g.depths) && write_whole(file, "a_scans", g.a_scans) &&
         write_whole(file, "b_scans", g.b_scans) &&
         write_real(file, "depth_spacing_um", g.depth_spacing_um) &&
         write_real(file, "a_spacing_um", g.a_spacing_um) &&
         write_real(file, "b_spacing_um", g.b_spacing_um) &&
         write_text(file, "assumed_spacings", g.assumed.words()) &&
         write_real(file, "refractive_index", g.refractive_index.value_or(medium_not_said)) &&
         write_real(file, "volume_period_s", facts.volume_period_s) &&
         write_text(file, "recorded_by", facts.recorded_by) &&
         write_text(file, "begun", facts.begun) && write_text(file, "source", facts.source) &&
         write_whole(file, "simulated", facts.simulated ? 1 : 0) &&
         write_text(file, "subject", facts.subject) &&
         write_text(file, "eye", std::string{to_string(facts.eye)}) &&
         write_text(file, "configuration", facts.configuration) && write_end(file, {});
}

bool write_end(hid_t file, const RecordingEnd& end) {
  return write_whole(file, "finished", end.finished ? 1 : 0) &&
         write_whole(file, "not_kept", static_cast<std::int64_t>(end.not_kept));
}

hal::Result<RecordingFacts> read_facts(hid_t file) {
  HAL_CHECK(check_format(file));
  RecordingFacts facts;
  FactReader reader{file};
  reader.read("depths", facts.geometry.depths);
  reader.read("a_scans", facts.geometry.a_scans);
  reader.read("b_scans", facts.geometry.b_scans);
  reader.read("depth_spacing_um", facts.geometry.depth_spacing_um);
  reader.read("a_spacing_um", facts.geometry.a_spacing_um);
  reader.read("b_spacing_um", facts.geometry.b_spacing_um);
  std::string assumed;
  reader.read_if_there("assumed_spacings", assumed);
  facts.geometry.assumed = AssumedSpacings::parse(assumed);
  reader.read("refractive_index", facts.geometry.refractive_index);
  reader.read("volume_period_s", facts.volume_period_s);
  reader.read("recorded_by", facts.recorded_by);
  reader.read("begun", facts.begun);
  reader.read("source", facts.source);
  reader.read("simulated", facts.simulated);
  reader.read("subject", facts.subject);
  std::string eye;
  reader.read("eye", eye);
  reader.read("configuration", facts.configuration);
  if (reader.error())
    return tl::make_unexpected(*reader.error());
  facts.eye = eye_named(eye).value_or(Eye::not_said);
  return facts;
}

hal::Result<RecordingEnd> read_end(hid_t file) {
  HAL_TRY(const auto finished, read_whole(file, "finished"));
  HAL_TRY(const auto not_kept, read_whole(file, "not_kept"));
  return RecordingEnd{.finished = finished != 0,
                      .not_kept = static_cast<std::uint64_t>(std::max<std::int64_t>(not_kept, 0))};
}

} // namespace octascope::pipeline
