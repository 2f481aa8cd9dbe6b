#include "pipeline/files/nrrd_header.h"

#include <algorithm>

#include <fmt/format.h>

#include "hal/number_text.h"
#include "pipeline/files/nrrd.h"

namespace octascope::pipeline {

using hal::ErrorCode;

namespace {

// A header is small: what has none in its first lines is no NRRD file.
constexpr int most_header_lines = 256;

// "Space Directions" and "space directions" are one field, as are "data file" and "datafile".
std::string plain_name(std::string_view name) {
  std::string plain = in_small_letters(name);
  std::erase(plain, ' ');
  return plain;
}

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
    text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

// What the file says, no longer than a message can hold.
std::string header_text(std::string_view text) {
  constexpr std::size_t most = 80;
  return text.size() <= most ? std::string{text} : fmt::format("{}…", text.substr(0, most));
}

// Without its end; nothing at the end of the text or when the line is longer than any of a header.
std::optional<std::string_view> next_line(std::string_view text, std::size_t& at) {
  const std::size_t end = text.substr(at, longest_nrrd_line + 2).find('\n');
  if (end == std::string_view::npos)
    return std::nullopt;
  std::string_view line = text.substr(at, end);
  at += end + 1;
  if (line.ends_with('\r'))
    line.remove_suffix(1);
  return line.size() <= longest_nrrd_line ? std::optional{line} : std::nullopt;
}

// The next number of a list; empty: there is none.
std::optional<double> next_number(std::string_view& text) {
  text = without_blanks(text);
  return hal::take_number<double>(text);
}

// The next word, in quotes or up to a space; empty: there is none.
std::optional<std::string> next_word(std::string_view& text) {
  text = without_blanks(text);
  if (text.empty())
    return std::nullopt;
  const bool quoted = text.front() == '"';
  std::string word;
  std::size_t at = quoted ? 1 : 0;
  for (; at < text.size() && text[at] != (quoted ? '"' : ' '); ++at) {
    if (quoted && text[at] == '\\' && at + 1 < text.size())
      ++at;
    word += text[at];
  }
  if (quoted && at == text.size())
    return std::nullopt;
  text.remove_prefix(std::min(at + (quoted ? 1 : 0), text.size()));
  return word;
}

} // namespace

std::string in_small_letters(std::string_view text) {
  std::string small{text};
  for (char& c : small)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return small;
}

hal::Result<NrrdHeader> NrrdHeader::parse(std::string_view text, std::string file) {
  NrrdHeader header{std::move(file)};
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; // an editor's mark of UTF-8
  const auto magic = next_line(text, at);
  if (!magic || magic->size() != 8 || !magic->starts_with("NRRD000") || magic->back() < '1' ||
      magic->back() > '5')
    return header.refuse("no NRRD magic in its first line", "NRRD0001 to NRRD0005");
  for (int count = 0; count < most_header_lines; ++count) {
    const auto line = next_line(text, at);
    if (!line)
      return header.end_without_empty_line(text.substr(at));
    header.bytes_ = at;
    if (line->empty())
      return header;
    HAL_CHECK(header.add_line(*line));
  }
  return header.refuse(fmt::format("more than {} header lines", most_header_lines), "fewer");
}

// A detached header ends with its file, and its last line may lack its end.
hal::Result<NrrdHeader> NrrdHeader::end_without_empty_line(std::string_view rest) {
  if (!rest.empty() && rest.size() <= longest_nrrd_line)
    HAL_CHECK(add_line(rest));
  if (find("data file") == nullptr)
    return refuse("a header that does not end", "an empty line before the data");
  bytes_ += rest.size();
  return *this;
}

hal::Result<> NrrdHeader::add_line(std::string_view line) {
  if (line.front() == '#')
    return {};
  const std::size_t colon = line.find(':');
  const std::string_view separator =
      colon == std::string_view::npos ? std::string_view{} : line.substr(colon, 2);
  if (separator == ":=") {
    keys_.emplace(line.substr(0, colon), line.substr(colon + 2));
    return {};
  }
  if (separator != ": ")
    return refuse(fmt::format("the header line \"{}\"", header_text(line)), "\"field: value\"");
  const std::string_view name = line.substr(0, colon);
  if (!fields_.emplace(plain_name(name), without_blanks(line.substr(colon + 2))).second)
    return refuse(fmt::format("the field \"{}\" twice", header_text(name)), "it once");
  // A list of names, which follows in lines of its own, or a pattern for them.
  if (const std::string* files = find("data file");
      files != nullptr &&
      (*files == "LIST" || files->starts_with("LIST ") || files->find('%') != std::string::npos))
    return refuse_field("data file", "one file; `unu save -f nrrd -i OLD -o NEW` of teem makes one "
                                     "of several");
  return {};
}

const std::string* NrrdHeader::find(std::string_view field) const {
  const auto found = fields_.find(plain_name(field));
  return found == fields_.end() ? nullptr : &found->second;
}

const std::string* NrrdHeader::find_key(std::string_view key) const {
  const auto found = keys_.find(key);
  return found == keys_.end() ? nullptr : &found->second;
}

hal::Result<std::optional<long long>> NrrdHeader::integer(std::string_view field) const {
  using Maybe = std::optional<long long>;
  const std::string* text = find(field);
  if (text == nullptr)
    return Maybe{};
  if (const auto number = hal::number_of<long long>(*text))
    return Maybe{number};
  return refuse_field(field, "a whole number");
}

hal::Result<std::optional<std::array<double, 3>>>
NrrdHeader::three_numbers(std::string_view field) const {
  using Maybe = std::optional<std::array<double, 3>>;
  const std::string* text = find(field);
  if (text == nullptr)
    return Maybe{};
  std::string_view rest = *text;
  std::array<double, 3> numbers{};
  for (double& number : numbers) {
    const auto next = next_number(rest);
    if (!next)
      return refuse_field(field, "three numbers");
    number = *next;
  }
  if (!without_blanks(rest).empty())
    return refuse_field(field, "three numbers");
  return Maybe{numbers};
}

hal::Result<std::optional<std::array<std::string, 3>>>
NrrdHeader::three_words(std::string_view field) const {
  using Maybe = std::optional<std::array<std::string, 3>>;
  const std::string* text = find(field);
  if (text == nullptr)
    return Maybe{};
  std::string_view rest = *text;
  std::array<std::string, 3> words;
  for (std::string& word : words) {
    auto next = next_word(rest);
    if (!next)
      return refuse_field(field, "three words, one an axis");
    word = std::move(*next);
  }
  if (!without_blanks(rest).empty())
    return refuse_field(field, "three words, one an axis");
  return Maybe{words};
}

tl::unexpected<hal::Error> NrrdHeader::refuse(std::string_view found,
                                              std::string_view expected) const {
  return hal::fail(ErrorCode::bad_data, "{}: found {}, expected {}", file_, found, expected);
}

tl::unexpected<hal::Error> NrrdHeader::refuse_field(std::string_view field,
                                                    std::string_view expected) const {
  const std::string* text = find(field);
  return refuse(text == nullptr ? fmt::format("no field \"{}\"", field)
                                : fmt::format("{}: {}", field, header_text(*text)),
                expected);
}

} // namespace octascope::pipeline
