#include "tests/support/program/built_places.h"

namespace octascope::tests {

std::string built_program() {
  return OCTASCOPE_PROGRAM;
}

} // namespace octascope::tests
