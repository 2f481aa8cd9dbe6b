// The one place where toml++ is compiled; see dependencies.cmake.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
