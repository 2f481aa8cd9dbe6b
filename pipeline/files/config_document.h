// Strict reading of a TOML file: every key is known, every value is in range, or the whole file is
// refused with file, line, key, what was found and what was expected.
//
// A ConfigTable hands out values and remembers which keys were asked for. The first complaint
// sticks to the document; values read after it are the defaults, so a reader needs no check after
// each line, only finish() at the end.
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
  // Each returns `fallback` when the key is not there.
  int integer(std::string_view key, int fallback, NumberRange range);
  double number(std::string_view key, double fallback, NumberRange range);
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string_view fallback);
  // One of `choices`; returns its index.
  std::size_t choice(std::string_view key, std::size_t fallback,
                     std::initializer_list<std::string_view> choices);
  // Finite numbers; an empty vector when the key is not there.
  std::vector<double> numbers(std::string_view key);
  // Lists of `columns` finite numbers each, [[0, 0], [1, 0.5]]; empty when the key is not there.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t columns);
  // A text, or a list of texts; an empty vector when the key is not there.
  std::vector<std::string> texts(std::string_view key);
  // The path of a file that is read, relative to the document's folder: one of named_files().
  std::optional<std::filesystem::path> path(std::string_view key);
  // The path of one that is written: none of them.
  std::optional<std::filesystem::path> output_path(std::string_view key);

  bool has(std::string_view key) const;
  // Is it there, and a whole number? For keys that take numbers as well as names.
  bool has_integer(std::string_view key) const;
  bool has_text(std::string_view key) const; // likewise
  // An empty table when it is not there.
  ConfigTable table(std::string_view key);
  // Entries of an array of tables ([[key]]), empty when it is not there.
  std::vector<ConfigTable> tables(std::string_view key);

  // Complains about this table: "<file>:<line>: [<table>] <message>".
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
  unsigned line = 0;          // where its name stands in the text: code points, from 1
  unsigned column = 0;
};

class ConfigDocument {
public:
  static hal::Result<ConfigDocument> load(const std::filesystem::path& file);
  static hal::Result<ConfigDocument> parse(std::string_view text,
                                           const std::filesystem::path& name);

  ConfigTable root() const { return root_; }

  // The first complaint, or the first key that nobody asked for; call it when all was read.
  hal::Result<> finish() const;

  // All of them, after finish(): for people who fix a file. What comes late may follow from what
  // came first.
  std::vector<std::string> complaints() const;

  // What was asked for with path() and is there, in the order of asking.
  std::vector<NamedFile> named_files() const;

  // The text with other names for those files: `names` has one for each of named_files(). For
  // copies that keep a document and its files together. ErrorCode::bad_data: a name could not be
  // found in the text.
  hal::Result<std::string> text_naming(std::span<const std::string> names) const;

private:
  explicit ConfigDocument(ConfigTable root) : root_(std::move(root)) {}
  ConfigTable root_;
};

} // namespace octascope::pipeline
