// Questions on the terminal, answered by lines: of a person, or of a script.
#pragma once

#include <initializer_list>
#include <istream>
#include <span>
#include <string>
#include <string_view>

#include "hal/result.h"

namespace octascope::firmware_host {

// An answer that does not do is told, and the question asked again. "quit" is an answer to every
// question. ErrorCode::disconnected: "quit", or there are no more answers; invalid_argument: five in
// a row did not do.
class Dialogue {
public:
  // `answers` outlives this. `echoes`: answers are repeated on standard output, as nobody types
  // them there.
  Dialogue(std::istream& answers, bool echoes) : answers_(answers), echoes_(echoes) {}

  // An empty answer is `fallback`.
  hal::Result<std::string> ask(std::string_view question, std::string_view fallback);

  hal::Result<double> ask_number(std::string_view question, double fallback, double lowest,
                                 double highest);
  hal::Result<int> ask_count(std::string_view question, int fallback, int lowest, int highest);

  // One of `words`, the first where the answer is empty, whole or by its first letter; "quit" may be
  // among them, and is offered where not.
  hal::Result<std::string> ask_word(std::string_view question,
                                    std::initializer_list<std::string_view> words);

  // As ask(); but one of `known`.
  hal::Result<std::string> ask_name(std::string_view question, std::string_view fallback,
                                    std::span<const std::string_view> known);

  bool by_script() const { return echoes_; } // nobody types the answers
  bool quit() const { return quit_; }        // it was answered
  bool ended() const { return ended_; }      // there were no more answers

private:
  hal::Error end_at(std::string_view question);

  std::istream& answers_;
  bool echoes_;
  bool quit_ = false;
  bool ended_ = false;
};

} // namespace octascope::firmware_host
