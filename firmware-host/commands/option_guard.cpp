#include "firmware-host/commands/option_guard.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware-host/configuration/configuration_check.h"
#include "hal/plain_text.h"
#include "pipeline/calibration/calibration_writer.h"
#include "pipeline/files/file_name.h"

namespace octascope::firmware_host {

namespace {

struct UsedFile {
  std::string option;
  std::filesystem::path file;
};

bool takes_text(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

bool is_file(const CLI::Option& option) {
  return option.get_type_name().starts_with("FILE");
}

bool is_written(const CLI::App& command, const CLI::Option& option) {
  if (option.get_name() == "--registration") // of a phantom's vessels, beside them
    return command.get_name() == "generate";
  if (option.get_name() == "--flow") // a switch of other commands
    return is_file(option);
  constexpr std::array<std::string_view, 7> written{
      "--out", "--snapshot", "--report", "--trace", "--png", "--picture", "--decorrelation"};
  return std::ranges::find(written, option.get_name()) != written.end();
}

// FILE.swc|.vessels: .swc and .vessels. None where the command itself tells what it writes.
std::vector<std::string> endings_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (!is_file(option) || type.find('.') == std::string::npos)
    return {};
  return CLI::detail::split(type.substr(type.find('.')), '|');
}

std::string check_text(const std::string& text, bool may_be_empty) {
  if (text.empty() && !may_be_empty)
    return "found an empty text, expected something";
  if (text.starts_with("--"))
    return fmt::format(
        "found \"{}\", which looks like an option, expected a value; of a file of that "
        "name, say ./{}",
        hal::shortened(text), hal::shortened(text));
  if (!hal::is_plain_text(text))
    return fmt::format("found \"{}\", with control characters or broken UTF-8 (shown as ?), "
                       "expected a text of one line in UTF-8",
                       hal::shortened(text));
  return {};
}

std::string check_ending(const std::string& file, const std::vector<std::string>& endings) {
  const std::string found = pipeline::file_ending(file);
  if (found.empty() || std::ranges::find(endings, found) != endings.end())
    return {};
  return fmt::format("found \"{}\", expected a name that ends with {}, which is what is written",
                     file, fmt::join(endings, " or "));
}

// With what the file names and is read with it.
void add_read(const std::string& option, const std::string& file, std::vector<UsedFile>& read) {
  read.push_back({option, file});
  std::vector<std::filesystem::path> named;
  if (option == "--config")
    named = files_of_configuration(file);
  if (option == "--calibration")
    named = files_of_calibration(file);
  for (const auto& other : named)
    read.push_back({fmt::format("{} {}", option, file), other});
}

// With what is written beside it.
void add_written(const CLI::App& command, const std::string& option, const std::string& file,
                 std::vector<UsedFile>& written) {
  written.push_back({option, file});
  if (option != "--out" || command.get_name() != "calibrate")
    return;
  for (const auto& curve : pipeline::curves_beside(file))
    written.push_back({option, curve});
}

void check_files(const CLI::App& command) {
  std::vector<UsedFile> read;
  std::vector<UsedFile> written;
  for (const CLI::Option* const option : command.get_options()) {
    for (const std::string& file : option->results()) {
      if (is_written(command, *option))
        add_written(command, option->get_name(), file, written);
      else if (is_file(*option))
        add_read(option->get_name(), file, read);
    }
  }
  for (std::size_t i = 0; i < written.size(); ++i) {
    const UsedFile& out = written[i];
    const auto is_out = [&](const UsedFile& other) {
      return pipeline::is_same_file(out.file, other.file);
    };
    if (const auto in = std::ranges::find_if(read, is_out); in != read.end())
      throw CLI::ValidationError(
          out.option, fmt::format("{} is a file that {} reads; expected another name: nothing "
                                  "was written",
                                  out.file.string(),
                                  in->option.starts_with("--") ? in->option : "the command"));
    const auto before = written.begin() + static_cast<std::ptrdiff_t>(i);
    if (const auto first = std::find_if(written.begin(), before, is_out); first != before)
      throw CLI::ValidationError(
          out.option, fmt::format("{} is the file that {} writes, too; expected two files: give "
                                  "one of them another name",
                                  out.file.string(), first->option));
  }
}

void guard_option(const CLI::App& command, CLI::Option& option) {
  const bool may_be_empty = option.get_name() == "--subject";
  option.check([may_be_empty](const std::string& text) { return check_text(text, may_be_empty); });
  if (const auto endings = endings_of(option); is_written(command, option) && !endings.empty())
    option.check([endings](const std::string& file) { return check_ending(file, endings); });
}

} // namespace

void guard_options(CLI::App& command) {
  for (CLI::Option* const option : command.get_options()) {
    if (takes_text(*option))
      guard_option(command, *option);
  }
  command.parse_complete_callback([&command] { check_files(command); });
  for (CLI::App* const subcommand : command.get_subcommands({}))
    guard_options(*subcommand);
}

} // namespace octascope::firmware_host
