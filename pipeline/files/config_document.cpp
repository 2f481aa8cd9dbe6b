#include "pipeline/files/config_document.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "hal/plain_text.h"
#include "pipeline/files/toml_text.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

struct Complaint {
  unsigned line = 0; // in the file, from 1; 0: of what is not there
  std::string text;
};

// What all tables of one document share.
struct Shared {
  toml::table table; // owns all nodes
  fs::path file;
  std::string text;
  std::vector<NamedFile> named;
  std::vector<Complaint> complaints;
};

std::string describe(const toml::node& node) {
  std::ostringstream text;
  node.visit([&](const auto& n) { text << n; });
  std::string words = text.str();
  std::ranges::replace(words, '\n', ' '); // a message is one line
  constexpr std::size_t longest = 60;
  if (words.size() > longest)
    words = words.substr(0, longest) + "…";
  return words;
}

std::optional<std::string> plain_text(const toml::node& node) {
  auto text = node.value_exact<std::string>();
  return text && hal::is_plain_text(*text) ? text : std::nullopt;
}

bool begins_code_point(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

std::size_t offset_of(std::string_view text, unsigned line, unsigned column) {
  std::size_t offset = 0;
  for (unsigned i = 1; i < line; ++i)
    offset = std::min(text.find('\n', offset), text.size() - 1) + 1;
  for (unsigned i = 1; i < column && offset < text.size(); ++i)
    do
      ++offset;
    while (offset < text.size() && !begins_code_point(text[offset]));
  return offset;
}

// How long the text in quotes is that begins there; 0 where none does. Names of files have neither
// line breaks nor, so far, needed three quotes.
std::size_t quoted_length(std::string_view text) {
  if (text.empty() || (text[0] != '"' && text[0] != '\'') || text.starts_with("\"\"\"") ||
      text.starts_with("'''"))
    return 0;
  for (std::size_t i = 1; i < text.size() && text[i] != '\n'; ++i) {
    if (text[i] == text[0])
      return i + 1;
    if (text[i] == '\\' && text[0] == '"')
      ++i;
  }
  return 0;
}

} // namespace

struct ConfigTable::Node {
  std::shared_ptr<Shared> shared;
  const toml::table* table = nullptr; // null: not in the file
  std::string name;                   // "" for the root
  std::set<std::string, std::less<>> asked;
  std::set<std::string, std::less<>> known; // those, and what would be asked for if it were there
  std::vector<std::shared_ptr<Node>> children;

  const toml::node* find(std::string_view key) {
    asked.emplace(key);
    known.emplace(key);
    return table == nullptr ? nullptr : table->get(key);
  }

  void complain_at(const toml::node* where, std::string_view message) {
    const std::string place = name.empty() ? "" : fmt::format("[{}] ", name);
    const unsigned line = where == nullptr ? 0U : where->source().begin.line;
    shared->complaints.push_back(
        {line, line == 0
                   ? fmt::format("{}: {}{}", shared->file.string(), place, message)
                   : fmt::format("{}:{}: {}{}", shared->file.string(), line, place, message)});
  }

  void complain_value(std::string_view key, const toml::node& found, std::string_view expected) {
    complain_at(&found, fmt::format("{} is {}, expected {}", key, describe(found), expected));
  }

  std::vector<double> numbers_in(std::string_view place, const toml::node& list) {
    const toml::array* array = list.as_array();
    if (array == nullptr) {
      complain_value(place, list, "a list of numbers, [..]");
      return {};
    }
    std::vector<double> values;
    values.reserve(array->size());
    for (const toml::node& element : *array) {
      const auto value = element.is_number() ? element.value<double>() : std::nullopt;
      if (!value || !std::isfinite(*value)) {
        complain_value(fmt::format("{}[{}]", place, values.size()), element, "a finite number");
        return {};
      }
      values.push_back(*value);
    }
    return values;
  }

  std::shared_ptr<Node> child(const toml::table* child_table, std::string child_name) {
    auto node = std::make_shared<Node>();
    node->shared = shared;
    node->table = child_table;
    node->name = name.empty() ? std::move(child_name) : name + "." + child_name;
    children.push_back(node);
    return node;
  }

  // Files whose names nothing else was wrong with.
  void complain_about_missing_files() const {
    for (const NamedFile& named : shared->named) {
      std::error_code error;
      const fs::file_status status = fs::status(named.file, error);
      if ((fs::exists(status) && !fs::is_directory(status)) ||
          std::ranges::find(shared->complaints, named.line, &Complaint::line) !=
              shared->complaints.end())
        continue;
      shared->complaints.push_back(
          {named.line,
           fmt::format("{}:{}: found {}, {}, expected a file", shared->file.string(), named.line,
                       named.file.string(),
                       fs::exists(status) ? "which is a folder" : "which is not there")});
    }
  }

  // The first key, in this table or below, that was never asked for.
  void complain_about_unknown_keys() {
    if (table != nullptr) {
      for (const auto& [key, value] : *table) {
        if (!asked.contains(key.str()))
          complain_at(&value, fmt::format("unknown key \"{}\"; known here: {}", key.str(),
                                          fmt::join(known, ", ")));
      }
    }
    for (const auto& c : children)
      c->complain_about_unknown_keys();
  }
};

int ConfigTable::integer(std::string_view key, int fallback, NumberRange range) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return fallback;
  const auto value = found->value_exact<std::int64_t>();
  if (value && static_cast<double>(*value) >= range.lowest &&
      static_cast<double>(*value) <= range.highest)
    return static_cast<int>(*value);
  node_->complain_value(key, *found,
                        fmt::format("a whole number from {} to {}", range.lowest, range.highest));
  return fallback;
}

double ConfigTable::number(std::string_view key, double fallback, NumberRange range) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return fallback;
  const auto value = found->is_number() ? found->value<double>() : std::nullopt;
  if (value && std::isfinite(*value) && *value >= range.lowest && *value <= range.highest)
    return *value;
  node_->complain_value(key, *found,
                        fmt::format("a number from {} to {}", range.lowest, range.highest));
  return fallback;
}

bool ConfigTable::boolean(std::string_view key, bool fallback) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return fallback;
  if (const auto value = found->value_exact<bool>())
    return *value;
  node_->complain_value(key, *found, "true or false");
  return fallback;
}

std::string ConfigTable::text(std::string_view key, std::string_view fallback) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return std::string{fallback};
  if (auto value = plain_text(*found))
    return std::move(*value);
  node_->complain_value(key, *found, "a text in quotes, without control characters");
  return std::string{fallback};
}

std::size_t ConfigTable::choice(std::string_view key, std::size_t fallback,
                                std::initializer_list<std::string_view> choices) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return fallback;
  const auto value = found->value_exact<std::string>();
  std::size_t index = 0;
  for (const std::string_view choice : choices) {
    if (value && *value == choice)
      return index;
    ++index;
  }
  node_->complain_value(key, *found, fmt::format("one of \"{}\"", fmt::join(choices, "\", \"")));
  return fallback;
}

std::vector<double> ConfigTable::numbers(std::string_view key) {
  const toml::node* found = node_->find(key);
  return found == nullptr ? std::vector<double>{} : node_->numbers_in(key, *found);
}

std::vector<std::vector<double>> ConfigTable::rows(std::string_view key, std::size_t columns) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return {};
  const std::string expected = fmt::format("a list of lists of {} numbers, [[..], ..]", columns);
  const toml::array* array = found->as_array();
  if (array == nullptr) {
    node_->complain_value(key, *found, expected);
    return {};
  }
  std::vector<std::vector<double>> rows;
  for (const toml::node& element : *array) {
    const std::string place = fmt::format("{}[{}]", key, rows.size());
    rows.push_back(node_->numbers_in(place, element));
    if (rows.back().size() == columns)
      continue;
    node_->complain_value(place, element, fmt::format("{} numbers", columns));
    return {};
  }
  return rows;
}

std::vector<std::string> ConfigTable::texts(std::string_view key) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return {};
  if (auto one = plain_text(*found))
    return {std::move(*one)};
  const toml::array* array = found->as_array();
  if (array == nullptr) {
    node_->complain_value(key, *found,
                          "a text in quotes, or a list of them, [..], without control characters");
    return {};
  }
  std::vector<std::string> values;
  values.reserve(array->size());
  for (const toml::node& element : *array) {
    auto value = plain_text(element);
    if (!value) {
      node_->complain_value(fmt::format("{}[{}]", key, values.size()), element,
                            "a text in quotes, without control characters");
      return {};
    }
    values.push_back(std::move(*value));
  }
  return values;
}

std::optional<fs::path> ConfigTable::path(std::string_view key) {
  auto file = output_path(key);
  if (file) {
    const toml::source_position place = node_->find(key)->source().begin;
    node_->shared->named.push_back({*file, place.line, place.column});
  }
  return file;
}

std::optional<fs::path> ConfigTable::output_path(std::string_view key) {
  const std::string name = text(key, "");
  if (name.empty())
    return std::nullopt;
  return node_->shared->file.parent_path() / name;
}

bool ConfigTable::has(std::string_view key) const {
  node_->known.emplace(key);
  return node_->table != nullptr && node_->table->contains(key);
}

bool ConfigTable::has_integer(std::string_view key) const {
  return node_->table != nullptr && node_->table->get(key) != nullptr &&
         node_->table->get(key)->is_integer();
}

bool ConfigTable::has_text(std::string_view key) const {
  return has(key) && node_->table->get(key)->is_string();
}

bool ConfigTable::has_boolean(std::string_view key) const {
  return has(key) && node_->table->get(key)->is_boolean();
}

ConfigTable ConfigTable::table(std::string_view key) {
  const toml::node* found = node_->find(key);
  const toml::table* child = found == nullptr ? nullptr : found->as_table();
  if (found != nullptr && child == nullptr)
    node_->complain_value(key, *found, fmt::format("a table, [{}]", key));
  return ConfigTable{node_->child(child, std::string{key})};
}

std::vector<ConfigTable> ConfigTable::tables(std::string_view key) {
  const toml::node* found = node_->find(key);
  if (found == nullptr)
    return {};
  const toml::array* array = found->as_array();
  if (array == nullptr) {
    node_->complain_value(key, *found, fmt::format("a list of tables, [[{}]]", key));
    return {};
  }
  std::vector<ConfigTable> entries;
  for (const toml::node& element : *array) {
    if (!element.is_table())
      node_->complain_value(key, element, fmt::format("a list of tables, [[{}]]", key));
    entries.push_back(ConfigTable{node_->child(element.as_table(), std::string{key})});
  }
  return entries;
}

void ConfigTable::complain(std::string_view message) {
  node_->complain_at(node_->table, message);
}

hal::Result<ConfigDocument> ConfigDocument::load(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    return hal::fail(ErrorCode::invalid_argument, "{}: is a directory, expected a TOML file",
                     file.string());
  std::ifstream in{file, std::ios::binary};
  if (!in)
    return hal::fail(ErrorCode::absent, "{}: cannot be opened: {}", file.string(),
                     std::generic_category().message(errno));
  std::ostringstream text;
  text << in.rdbuf();
  return parse(text.str(), file);
}

hal::Result<ConfigDocument> ConfigDocument::parse(std::string_view text, const fs::path& name) {
  toml::parse_result parsed = toml::parse(text, name.string());
  if (!parsed) {
    const toml::parse_error& e = parsed.error();
    return hal::fail(ErrorCode::bad_data, "{}:{}:{}: not TOML: {}", name.string(),
                     e.source().begin.line, e.source().begin.column, e.description());
  }
  auto shared = std::make_shared<Shared>();
  shared->table = std::move(parsed).table();
  shared->file = name;
  shared->text = text;
  auto node = std::make_shared<ConfigTable::Node>();
  node->table = &shared->table;
  node->shared = std::move(shared);
  return ConfigDocument{ConfigTable{std::move(node)}};
}

std::vector<NamedFile> ConfigDocument::named_files() const {
  return root_.node_->shared->named;
}

hal::Result<std::string> ConfigDocument::text_naming(std::span<const std::string> names) const {
  const Shared& shared = *root_.node_->shared;
  std::vector<std::pair<std::size_t, std::string>> places;
  for (std::size_t i = 0; i < shared.named.size(); ++i)
    places.emplace_back(offset_of(shared.text, shared.named[i].line, shared.named[i].column),
                        names[i]);
  std::ranges::sort(places);
  std::string text;
  std::size_t taken = 0;
  for (const auto& [offset, name] : places) {
    const std::size_t length = quoted_length(std::string_view{shared.text}.substr(offset));
    if (length == 0 || offset < taken)
      return hal::fail(ErrorCode::bad_data,
                       "{}: cannot be copied with its files: expected \"{}\" in simple quotes",
                       shared.file.string(), name);
    text += shared.text.substr(taken, offset - taken) + toml_text(name);
    taken = offset + length;
  }
  return text + shared.text.substr(taken);
}

hal::Result<> ConfigDocument::finish() const {
  root_.node_->complain_about_unknown_keys();
  const auto& complaints = root_.node_->shared->complaints;
  return complaints.empty() ? hal::Result<>{}
                            : hal::fail(ErrorCode::invalid_argument, complaints.front().text);
}

void ConfigDocument::complain_about_missing_files() const {
  root_.node_->complain_about_missing_files();
}

std::vector<std::string> ConfigDocument::complaints() const {
  std::vector<Complaint> sorted = root_.node_->shared->complaints;
  std::ranges::stable_sort(sorted, {}, &Complaint::line);
  std::vector<std::string> texts;
  for (const Complaint& complaint : sorted)
    texts.push_back(complaint.text);
  return texts;
}

} // namespace octascope::pipeline
