// What holds for the options of every command, checked in one place, before a command begins.
#pragma once

#include <CLI/App.hpp>

namespace octascope::firmware_host {

// Gives the options of the command and of its subcommands these checks, wrong use otherwise:
// - Texts are UTF-8 without control characters, and not empty but for --subject.
// - The name of a file to write ends as its type name says (FILE.png: .png, in small or capital
//   letters), or has no ending.
// - No file is written that is also read, nor two times, whatever way its names lead to it.
// Files to write are known by their options' names (--out, --snapshot, --report, --png,
// --picture, --flow, --decorrelation, and --registration of vessels generate); the others with a type name that begins with
// FILE are read.
void guard_options(CLI::App& command);

} // namespace octascope::firmware_host
