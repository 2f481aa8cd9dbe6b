// Strict reading of a TOML file. An unknown key or a value out of range makes the whole file
// invalid; the message gives file, line, key, what was found and what was expected.
//
// A ConfigTable returns values and remembers which keys were read. Complaints are kept in the
// document and a bad value reads as its default, so a reader need not check after each value, only
// call finish() at the end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.h"

namespace octascope::pipeline {

struct NumberRange {
  double lowest;
  double highest;
};

class ConfigTable {
public:
  // Each returns `fallback` if the key is absent.
  int integer(std::string_view key, int fallback, NumberRange range);
  double number(std::string_view key, double fallback, NumberRange range);
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string_view fallback);
  // One of `choices`; returns its index.
  std::size_t choice(std::string_view key, std::size_t fallback,
                     std::initializer_list<std::string_view> choices);
  // Finite numbers; empty if the key is absent.
  std::vector<double> numbers(std::string_view key);
  // Lists of `columns` finite numbers each, [[0, 0], [1, 0.5]]; empty if the key is absent.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t columns);
  // A string or a list of strings; empty if the key is absent.
  std::vector<std::string> texts(std::string_view key);
  // The path of an input file, resolved against the document's folder; added to named_files().
  std::optional<std::filesystem::path> path(std::string_view key);
  // The path of an output file; not added to named_files().
  std::optional<std::filesystem::path> output_path(std::string_view key);

  bool has(std::string_view key) const;
  // Present, and an integer? For keys that accept numbers as well as names.
  bool has_integer(std::string_view key) const;
  bool has_text(std::string_view key) const;    // likewise
  bool has_boolean(std::string_view key) const; // likewise
  // An empty table if the key is absent.
  ConfigTable table(std::string_view key);
  // Entries of an array of tables ([[key]]); empty if the key is absent.
  std::vector<ConfigTable> tables(std::string_view key);

  // Adds a complaint about this table: "<file>:<line>: [<table>] <message>".
  void complain(std::string_view message);
  template <class First, class... Rest>
  void complain(fmt::format_string<First, Rest...> pattern, First&& first, Rest&&... rest) {
    complain(fmt::format(pattern, std::forward<First>(first), std::forward<Rest>(rest)...));
  }

private:
  friend class ConfigDocument;
  struct Node;
  explicit ConfigTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::shared_ptr<Node> node_;
};

// A file that a document names.
struct NamedFile {
  std::filesystem::path file; // as ConfigTable::path() gave it
  unsigned line = 0;          // position of its name in the text, from 1
  unsigned column = 0;        // in code points, from 1
};

class ConfigDocument {
public:
  static hal::Result<ConfigDocument> load(const std::filesystem::path& file);
  static hal::Result<ConfigDocument> parse(std::string_view text,
                                           const std::filesystem::path& name);

  ConfigTable root() const { return root_; }

  // Returns the first complaint, if any, as an Error. Call it after everything was read: keys that
  // were never read are complaints too.
  hal::Result<> finish() const;

  // Adds a complaint for each of named_files() that is not there, unless there is one already.
  void complain_about_missing_files() const;

  // All complaints, once finish() was called, in the order of the file: for people who fix it. Later
  // ones may be consequences of earlier ones.
  std::vector<std::string> complaints() const;

  // The files read with path() whose keys are present, in the order of reading.
  std::vector<NamedFile> named_files() const;

  // The text with those files renamed: `names` has one name for each of named_files(). For copies
  // that keep a document and its files together. ErrorCode::bad_data: a file's name in the text is
  // not a simple quoted string.
  hal::Result<std::string> text_naming(std::span<const std::string> names) const;

private:
  explicit ConfigDocument(ConfigTable root) : root_(std::move(root)) {}
  ConfigTable root_;
};

} // namespace octascope::pipeline
