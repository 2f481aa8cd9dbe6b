// What the last frames changed: a buffer that holds an older image lacks more than the last one's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/display.h"
#include "ui/damage/damage.h"

namespace octascope::ui {

// Threads: one at a time. Allocates when the size grows.
class DamageHistory {
public:
  // Of what was drawn, nothing is known any more: all of the next image is drawn.
  void forget();

  // `damage`, what this image changed against the one that was drawn before it, becomes what
  // `buffer` lacks. An image that is drawn again before it was handed over keeps its number; one
  // without a number is drawn as a whole, and so is the one after it. Where it is not known what the
  // buffer holds, all of it is drawn, and of the others, too, when it is their turn.
  void add(const hal::BackBuffer& buffer, Damage& damage);

private:
  // Displays have two or three buffers.
  static constexpr std::size_t kept = 4;

  struct Entry {
    std::uint64_t image = 0; // 0: none
    Damage damage;
  };

  const Entry* find(std::uint64_t image) const;

  std::array<Entry, kept> entries_; // of image n: the n-th modulo their number
  bool unknown_ = true;             // what was drawn last has no number
};

} // namespace octascope::ui
