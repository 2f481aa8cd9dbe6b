// The example and the table of keys keep up with what the reader knows.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "firmware-host/configuration/configuration_check.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/program/built_places.h"

namespace octascope::firmware_host {
namespace {

namespace fs = std::filesystem;

using KeysBySection = std::map<std::string, std::set<std::string>>;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream{file}.rdbuf();
  return text.str();
}

// What the reader says that it knows there, when it is given something else.
std::set<std::string> known_keys(const std::string& text) {
  const tests::ScratchFolder folder;
  const auto read = load_configuration(folder.write("c.toml", text));
  constexpr std::string_view before = "known here: ";
  const std::string told = read ? "" : read.error().message;
  const std::size_t at = told.find(before);
  EXPECT_NE(at, std::string::npos) << text << told;
  std::istringstream list{at == std::string::npos ? "" : told.substr(at + before.size())};
  std::set<std::string> keys;
  for (std::string key; std::getline(list >> std::ws, key, ',');)
    keys.insert(key);
  return keys;
}

KeysBySection everything_that_is_read() {
  KeysBySection sections;
  for (const std::string& section : known_keys("strange = 1\n")) {
    std::string header = "[" + section + "]\n";
    if (section == "objective")
      header = "[microscope]\nobjective = \"a\"\n[[objective]]\nname = \"a\"\n";
    if (section == "transfer") // what `table` reads and `piecewise` does not
      header = "[[transfer]]\nname = \"a\"\npoints = [[0, 0], [1, 1]]\n";
    sections[section] = known_keys(header + "strange = 1\n");
  }
  sections["transfer"].insert("file");
  return sections;
}

// Keys by section in the example, those behind a # included.
KeysBySection keys_of_example() {
  KeysBySection sections;
  std::string section;
  std::istringstream lines{text_of(tests::source_folder() / "deploy/example.toml")};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("# "))
      line = line.substr(2);
    const std::size_t name = line.find_first_not_of('[');
    const std::size_t end = line.find_first_of(" =]");
    if (line.starts_with('[') && end != std::string::npos)
      section = line.substr(name, end - name);
    else if (end != std::string::npos && line.substr(end).starts_with(" = "))
      sections[section].insert(line.substr(0, end));
  }
  return sections;
}

TEST(ExampleConfiguration, can_be_run_on) {
  const auto read = load_whole_configuration(tests::source_folder() / "deploy/example.toml");
  EXPECT_TRUE(read) << read.error().message;
}

TEST(ExampleConfiguration, has_every_key_and_no_other) {
  const KeysBySection example = keys_of_example();
  const KeysBySection known = everything_that_is_read();
  EXPECT_GE(known.size(), 10U);
  EXPECT_EQ(example, known);
}

// The rows of the table, each section from its heading to the next.
TEST(ExampleConfiguration, is_explained_key_by_key) {
  const std::string text = text_of(tests::source_folder() / "docs/CONFIGURATION.md");
  for (const auto& [section, keys] : everything_that_is_read()) {
    std::size_t begin = text.find("| **[" + section + "]");
    if (begin == std::string::npos)
      begin = text.find("| **[[" + section + "]]");
    ASSERT_NE(begin, std::string::npos) << section;
    const std::string rows = text.substr(begin, text.find("| **[", begin + 1) - begin);
    for (const std::string& key : keys)
      EXPECT_NE(rows.find("| `" + key + "` |"), std::string::npos) << section << ": " << key;
  }
}

} // namespace
} // namespace octascope::firmware_host
