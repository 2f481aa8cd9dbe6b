// HDF5's handles, closed when they go, and its errors as ours.
#pragma once

#include <string>
#include <utility>

#include <hdf5.h>

#include "hal/result.h"

namespace octascope::pipeline {

// Of a file, a dataset, a type, a space, a property list or an attribute.
class Hdf5Handle {
public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close how) : id_(id), close_(how) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() { static_cast<void>(close()); }

  bool valid() const { return id_ >= 0; }
  operator hid_t() const { return id_; }
  void leave_open() { id_ = H5I_INVALID_HID; }
  herr_t close() { return valid() ? close_(std::exchange(id_, H5I_INVALID_HID)) : 0; }

private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

// While it lives HDF5 prints nothing on this thread: what failed is told in our words.
class Hdf5Silence {
public:
  Hdf5Silence();
  ~Hdf5Silence();
  Hdf5Silence(const Hdf5Silence&) = delete;
  Hdf5Silence& operator=(const Hdf5Silence&) = delete;

private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

// The innermost reason of HDF5's last failure on this thread, in its words.
std::string hdf5_reason();

// What values of such a type are, for messages.
const char* name_of(H5T_class_t type);

} // namespace octascope::pipeline
