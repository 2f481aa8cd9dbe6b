#include "pipeline/recordings/hdf5/hdf5.h"

namespace octascope::pipeline {

Hdf5Silence::Hdf5Silence() {
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
  return reason.empty() ? "HDF5 gives no reason" : reason;
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
