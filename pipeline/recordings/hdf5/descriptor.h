// An owned file descriptor.
#pragma once

#include <unistd.h>

namespace octascope::pipeline {

class Descriptor {
public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0)
      ::close(number_);
  }
  operator int() const { return number_; }

private:
  int number_;
};

} // namespace octascope::pipeline
