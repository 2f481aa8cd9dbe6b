// Options for reading a vessel tree, shared by every command that takes one.
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "pipeline/vessels/files/tree_reading.h"

namespace octascope::firmware_host {

// What CLI11 fills in.
struct TreeArguments {
  std::string unit;
  std::string zero_radius = "parent";
  bool forest = false;
  bool strict = false;

  pipeline::TreeReadOptions options() const;
};

// Adds --unit, --forest, --strict and --zero-radius. `arguments` must outlive the parsing.
void add_tree_options(CLI::App& command, TreeArguments& arguments);

} // namespace octascope::firmware_host
