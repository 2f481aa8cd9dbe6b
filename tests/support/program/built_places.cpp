#include "tests/support/program/built_places.h"

namespace octascope::tests {

std::filesystem::path source_folder() {
  return OCTASCOPE_SOURCE_DIR;
}

} // namespace octascope::tests
