#include <cstdio>

#include "firmware-host/version.h"

int main() {
  std::puts(octascope::firmware_host::version().data());
  return 0;
}
