#include "pipeline/recordings/hdf5/hdf5.h"

#include <string_view>

namespace octascope::pipeline {

namespace {

// Of a failed system call HDF5 tells all that it knows, over several lines.
std::string without_details(const std::string& reason) {
  constexpr std::string_view before = "error message = '";
  const std::size_t details = reason.find(": time = ");
  const std::size_t error = reason.find(before);
  if (details == std::string::npos || error == std::string::npos)
    return reason;
  const std::size_t begin = error + before.size();
  return reason.substr(0, details + 2) + reason.substr(begin, reason.find('\'', begin) - begin);
}

} // namespace

// At the end of the program HDF5 would close what it could not write, and crash of it: all that we
// open we close ourselves.
Hdf5Silence::Hdf5Silence() {
  [[maybe_unused]] static const herr_t once = H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Silence::~Hdf5Silence() {
  H5Eset_auto2(H5E_DEFAULT, print_, data_);
}

std::string hdf5_reason() {
  std::string reason;
  const auto keep_first = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    auto& kept = *static_cast<std::string*>(text);
    if (kept.empty() && error->desc != nullptr)
      kept = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  return reason.empty() ? "HDF5 gives no reason" : without_details(reason);
}

const char* name_of(H5T_class_t type) {
  switch (type) {
  case H5T_INTEGER: return "whole numbers";
  case H5T_FLOAT: return "numbers";
  case H5T_STRING: return "texts";
  case H5T_COMPOUND: return "records";
  default: return "another type";
  }
}

} // namespace octascope::pipeline
