#include "firmware-host/commands/tree_options.h"

#include <CLI/CLI.hpp>

namespace octascope::firmware_host {

pipeline::TreeReadOptions TreeArguments::options() const {
  pipeline::TreeReadOptions options;
  if (!unit.empty())
    options.unit = unit == "um" ? pipeline::LengthUnit::um : pipeline::LengthUnit::mm;
  options.forest = forest;
  options.strict = strict;
  options.zero_radius =
      zero_radius == "refuse" ? pipeline::ZeroRadius::refuse : pipeline::ZeroRadius::parent;
  return options;
}

void add_tree_options(CLI::App& command, TreeArguments& arguments) {
  command
      .add_option("--unit", arguments.unit,
                  "Unit of the file's lengths, which it does not say itself: um if not given for "
                  "SWC, mm for VTP")
      ->check(CLI::IsMember({"um", "mm"}))
      ->type_name("um|mm")
      ->option_text("um|mm");
  command.add_flag("--forest", arguments.forest, "Several roots are fine");
  command.add_flag("--strict", arguments.strict, "A parent in a later row of an SWC file is not");
  command
      .add_option("--zero-radius", arguments.zero_radius,
                  "Nodes of radius 0: they get their parent's (if not given), or the file is "
                  "refused")
      ->check(CLI::IsMember({"parent", "refuse"}))
      ->type_name("parent|refuse")
      ->option_text("parent|refuse");
}

} // namespace octascope::firmware_host
