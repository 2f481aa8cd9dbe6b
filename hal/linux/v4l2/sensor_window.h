// The region of a sensor that is read out.
#pragma once

namespace octascope::hal::linux_backend {

struct SensorWindow { // in pixels of the sensor
  int left = 0, top = 0;
  int width = 0, height = 0;
  bool operator==(const SensorWindow&) const = default;
};

} // namespace octascope::hal::linux_backend
