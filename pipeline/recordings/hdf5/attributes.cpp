#include "pipeline/recordings/hdf5/attributes.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include "pipeline/recordings/hdf5/variable_text.h"

namespace octascope::pipeline {

namespace {

constexpr std::size_t longest_text = std::size_t{1} << 20; // in a file that somebody else made

bool write_number(hid_t file, const char* name, hid_t stored, hid_t native, const void* value) {
  const Hdf5Handle space{H5Screate(H5S_SCALAR), H5Sclose};
  const bool there = H5Aexists(file, name) > 0;
  const Hdf5Handle attribute{there
                                 ? H5Aopen(file, name, H5P_DEFAULT)
                                 : H5Acreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose};
  return attribute.valid() && H5Awrite(attribute, native, value) >= 0;
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
    return bad_attribute(name, fmt::format("found none, expected {}", expected));
  found.type = Hdf5Handle{H5Aget_type(found.attribute), H5Tclose};
  const H5T_class_t type_class = H5Tget_class(found.type);
  if (std::ranges::find(takes, type_class) == takes.end())
    return bad_attribute(name, fmt::format("found {}, expected {}", name_of(type_class), expected));
  const Hdf5Handle space{H5Aget_space(found.attribute), H5Sclose};
  if (const hssize_t count = H5Sget_simple_extent_npoints(space); count != 1)
    return bad_attribute(name, fmt::format("found {} values, expected {}", count, expected));
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

} // namespace

tl::unexpected<hal::Error> bad_attribute(const char* name, const std::string& what) {
  return hal::fail(hal::ErrorCode::bad_data, "attribute {}: {}", name, what);
}

// At least one byte: HDF5 knows no empty text.
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

bool write_whole(hid_t file, const char* name, std::int64_t value) {
  return write_number(file, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

bool write_real(hid_t file, const char* name, double value) {
  return write_number(file, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

hal::Result<std::string> read_text(hid_t file, const char* name) {
  HAL_TRY(const auto found, find(file, name, {H5T_STRING}, "a text"));
  const auto text = H5Tis_variable_str(found.type) > 0
                        ? read_variable_text(found.attribute, longest_text)
                        : read_fixed_text(found);
  if (!text)
    return bad_attribute(name, text.error().message);
  return text->substr(0, text->find('\0'));
}

// Other programs write truth as an enumeration.
hal::Result<std::int64_t> read_whole(hid_t file, const char* name) {
  HAL_TRY(const auto found, find(file, name, {H5T_INTEGER, H5T_ENUM}, "a whole number"));
  std::int64_t value = 0;
  if (H5Aread(found.attribute, H5T_NATIVE_INT64, &value) < 0)
    return bad_attribute(name, "cannot be read: " + hdf5_reason());
  return value;
}

hal::Result<double> read_real(hid_t file, const char* name) {
  HAL_TRY(const auto found, find(file, name, {H5T_FLOAT, H5T_INTEGER}, "a number"));
  double value = 0;
  if (H5Aread(found.attribute, H5T_NATIVE_DOUBLE, &value) < 0)
    return bad_attribute(name, "cannot be read: " + hdf5_reason());
  return value;
}

void AttributeReader::read(const char* name, std::string& value) {
  take(value, [&] { return read_text(file_, name); });
}

void AttributeReader::read(const char* name, bool& value) {
  std::int64_t whole = 0;
  take(whole, [&] { return read_whole(file_, name); });
  value = whole != 0;
}

void AttributeReader::read(const char* name, int& value, int lowest, int highest) {
  std::int64_t whole = 0;
  take(whole, [&] { return read_whole(file_, name); });
  if (!error_ && (whole < lowest || whole > highest))
    error_ = bad_attribute(name, fmt::format("found {}, expected {} to {}", whole, lowest, highest))
                 .value();
  value = static_cast<int>(whole);
}

void AttributeReader::read(const char* name, double& value) {
  take(value, [&] { return read_real(file_, name); });
  if (!error_ && !(std::isfinite(value) && value > 0))
    error_ = bad_attribute(name, fmt::format("found {}, expected more than zero", value)).value();
}

void AttributeReader::read_if_there(const char* name, std::string& value) {
  if (H5Aexists(file_, name) > 0)
    read(name, value);
}

} // namespace octascope::pipeline
