// Where this build's sources and its program lie. They are told to one file each (built_places.cpp,
// built_program.cpp): with a path in every file's command line, no compiler cache would serve
// another checkout.
#pragma once

#include <filesystem>
#include <string>

namespace octascope::tests {

std::filesystem::path source_folder();

// The built program; only where a test links octascope_built_program.
std::string built_program();

} // namespace octascope::tests
