// The header of a NRRD file: its fields as text, and what they say about shape and place.
//
// Format: https://teem.sourceforge.net/nrrd/format.html
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::pipeline {

// Of ASCII letters only. Most words of the format may be written in capitals.
std::string in_small_letters(std::string_view text);

class NrrdHeader {
public:
  // `text` begins with the header; `file` is for messages.
  static hal::Result<NrrdHeader> parse(std::string_view text, std::string file);

  const std::string& file() const { return file_; }
  // Including the empty line that ends it, which a detached header may lack.
  std::size_t bytes() const { return bytes_; }

  // `field` is in small letters, as in the format's definition; files may use capitals, and some
  // leave out the space. Null: the header lacks the field.
  const std::string* find(std::string_view field) const;
  // The value of `key:=value`, with its escapes; null: the header lacks the key.
  const std::string* find_key(std::string_view key) const;

  // Empty: the header lacks the field. ErrorCode::bad_data, with the field's name: it is no number.
  hal::Result<std::optional<long long>> integer(std::string_view field) const;
  hal::Result<std::optional<std::array<double, 3>>> three_numbers(std::string_view field) const;
  // One value an axis, in quotes or not.
  hal::Result<std::optional<std::array<std::string, 3>>> three_words(std::string_view field) const;

  tl::unexpected<hal::Error> refuse(std::string_view found, std::string_view expected) const;
  // Likewise; what was found is the field and its text.
  tl::unexpected<hal::Error> refuse_field(std::string_view field, std::string_view expected) const;

private:
  explicit NrrdHeader(std::string file) : file_(std::move(file)) {}
  hal::Result<> add_line(std::string_view line);
  hal::Result<NrrdHeader> end_without_empty_line(std::string_view rest);

  std::string file_;
  std::size_t bytes_ = 0;
  std::map<std::string, std::string, std::less<>> fields_; // names without spaces
  std::map<std::string, std::string, std::less<>> keys_;
};

// Shape and spacings, in array order depth, A-scan, B-scan. A spacing is the length of the axis's
// space direction, or what `spacings` says, converted from the file's units. Where the array lies
// in its space is not kept: the volume has a frame of its own. Refused, with the way round: what
// that frame cannot hold (axes that are not perpendicular or that mirror the volume, other kinds of
// axes), unknown units and fields that contradict each other. What had to be assumed is added to
// `remarks`, a sentence each.
hal::Result<VolumeGeometry> nrrd_geometry(const NrrdHeader& header,
                                          std::vector<std::string>& remarks);

} // namespace octascope::pipeline
