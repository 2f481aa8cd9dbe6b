// The data arrays of a VTK XML file: from text or bytes to numbers.
//
// Format: VTK File Formats (docs.vtk.org), "XML File Formats". ascii; binary, which is base64;
// appended, raw or base64; blocks compressed by zlib or plain. Little-endian.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "hal/result.h"

namespace octascope::pipeline {

// What the file says of all its arrays. Borrows the file's text.
struct VtpEncoding {
  int header_bytes = 4; // of a word in front of the data, 4 or 8
  bool compressed = false;
  bool appended_is_base64 = false;
  std::string_view appended; // behind the underscore
};

// The numbers of a DataArray, `count` of them or an error, without the file's name. Numbers may be
// of any type; they are finite. An empty node is an array that is not there, fine when count is 0.
hal::Result<std::vector<double>> read_vtp_numbers(const pugi::xml_node& array,
                                                  const VtpEncoding& encoding, std::uint64_t count);

// The same for whole numbers of 0 or more.
hal::Result<std::vector<std::uint64_t>>
read_vtp_indices(const pugi::xml_node& array, const VtpEncoding& encoding, std::uint64_t count);

} // namespace octascope::pipeline
