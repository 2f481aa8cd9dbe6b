#include "firmware-host/commands/commission/dialogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware-host/terminal/terminal.h"
#include "hal/number_text.h"

namespace octascope::firmware_host {

namespace {

constexpr int most_wrong_answers = 5;
constexpr std::string_view quit_word = "quit";
constexpr std::string_view blanks = " \t\r";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? std::string{}
                            : text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

hal::Error too_many_wrong_answers(std::string_view question) {
  return {hal::ErrorCode::invalid_argument,
          fmt::format("{} answers in a row did not do for \"{}\"; the same command goes on from "
                      "there",
                      most_wrong_answers, question)};
}

} // namespace

hal::Result<std::string> Dialogue::ask(std::string_view question, std::string_view fallback) {
  say("{} [{}] ", question, fallback);
  std::fflush(stdout);
  std::string line;
  if (!std::getline(answers_, line)) {
    say("\n");
    ended_ = true;
    return hal::fail(
        hal::ErrorCode::disconnected,
        "no answer to \"{}\": the input has ended; the same command goes on from there", question);
  }
  const std::string answer = trimmed(line);
  if (echoes_)
    say("{}\n", answer);
  const std::string taken = answer.empty() ? std::string{fallback} : answer;
  if (taken == quit_word)
    return tl::make_unexpected(end_at(question));
  return taken;
}

hal::Error Dialogue::end_at(std::string_view question) {
  quit_ = true;
  return {hal::ErrorCode::disconnected, fmt::format("\"{}\" was answered with quit", question)};
}

hal::Result<double> Dialogue::ask_number(std::string_view question, double fallback, double lowest,
                                         double highest) {
  for (int wrong = 0; wrong < most_wrong_answers; ++wrong) {
    HAL_TRY(const std::string answer, ask(question, fmt::format("{}", fallback)));
    const auto number = hal::number_of<double>(answer);
    if (number && *number >= lowest && *number <= highest)
      return *number;
    say("  found \"{}\", expected a number from {} to {}\n", answer, lowest, highest);
  }
  return tl::make_unexpected(too_many_wrong_answers(question));
}

hal::Result<int> Dialogue::ask_count(std::string_view question, int fallback, int lowest,
                                     int highest) {
  for (int wrong = 0; wrong < most_wrong_answers; ++wrong) {
    HAL_TRY(const std::string answer, ask(question, fmt::format("{}", fallback)));
    const auto number = hal::number_of<int>(answer);
    if (number && *number >= lowest && *number <= highest)
      return *number;
    say("  found \"{}\", expected a whole number from {} to {}\n", answer, lowest, highest);
  }
  return tl::make_unexpected(too_many_wrong_answers(question));
}

hal::Result<std::string> Dialogue::ask_word(std::string_view question,
                                            std::initializer_list<std::string_view> words) {
  std::vector<std::string_view> offered{words};
  if (std::ranges::find(offered, quit_word) == offered.end())
    offered.push_back(quit_word);
  for (int wrong = 0; wrong < most_wrong_answers; ++wrong) {
    HAL_TRY(const std::string answer,
            ask(fmt::format("{} ({})", question, fmt::join(offered, ", ")), offered.front()));
    for (const std::string_view word : offered)
      if (answer == word || (answer.size() == 1 && answer[0] == word[0])) {
        if (word == quit_word)
          return tl::make_unexpected(end_at(question));
        return std::string{word};
      }
    say("  found \"{}\", expected one of: {}\n", answer, fmt::join(offered, ", "));
  }
  return tl::make_unexpected(too_many_wrong_answers(question));
}

hal::Result<std::string> Dialogue::ask_name(std::string_view question, std::string_view fallback,
                                            std::span<const std::string_view> known) {
  for (int wrong = 0; wrong < most_wrong_answers; ++wrong) {
    HAL_TRY(std::string answer, ask(question, fallback));
    if (std::ranges::find(known, answer) != known.end())
      return answer;
    say("  found \"{}\", expected one of: {}\n", answer, fmt::join(known, ", "));
  }
  return tl::make_unexpected(too_many_wrong_answers(question));
}

} // namespace octascope::firmware_host
